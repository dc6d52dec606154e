"""The extension installed as an artist may: its zip dropped onto Blender's window, which asks, and installs it.

    blender --python tests/window/drop.py

from the folder of this repository, on an X screen with `xdotool`. Unlike the other scripts it needs real events of the
screen, which Blender does not take while it simulates them. The script builds the zip, drops it by a source of its own
(`drag_source.py`), presses the button of the question, and asks whether the extension is at work. Pictures go to the
folder WINDOW_SHOTS, build/window where that is not set.
"""
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import Screen, built_zip, run, settled, turned_to_tab, waiting


def steps():
    # what --enable-event-simulate of the other scripts switches on would shut out the screen's own events
    bpy.app.use_event_simulate = False
    screen = Screen()
    x, y = screen.centre["x"], screen.window.height - screen.centre["y"]
    typed("mousemove", str(x), str(y))
    yield 1.0
    typed("key", "Escape")
    yield 1.0
    assert not installed()
    source = subprocess.Popen([sys.executable, str(Path(__file__).with_name("drag_source.py")), str(built_zip()),
                               str(x), str(y)])
    yield from waiting(lambda: source.poll() is not None, "the drop")
    assert source.returncode == 0
    yield from settled("drop_1_asked")
    begun = time.time()
    typed("key", "Return")
    yield from waiting(installed, "the extension")
    # the folder of a virtual screen may know the extension from another script
    folder = Path(bpy.utils.user_resource("EXTENSIONS", path="user_default")) / "reflection_mesh"
    assert (folder / "blender_manifest.toml").stat().st_ctime > begun
    typed("key", "n")
    yield from waiting(lambda: turned_to_tab(screen), "the tab Reflection", 20.0)
    yield from settled("drop_2_installed")


def typed(*words: str) -> None:
    subprocess.run(["xdotool", *words], check=True)


def installed() -> bool:
    return hasattr(bpy.types.Scene, "reflection_mesh")


run(steps)
