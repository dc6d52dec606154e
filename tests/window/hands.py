"""Hands and eyes for the scripts of this folder: keys, mouse and pictures of a real Blender with its window.

A script is a generator of pauses in seconds; `run` steps it by a timer and ends Blender, with status 0 where everything
held.
"""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Generator, Iterator
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
SHOTS = Path(os.environ.get("WINDOW_SHOTS", ROOT / "build" / "window")).resolve()
KEYS = {" ": "SPACE", ".": "PERIOD", "-": "MINUS", **{str(number): name for number, name in enumerate((
    "ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE"))}}


class Screen:
    """The largest 3D viewport of the first window, and the hands before it."""

    def __init__(self) -> None:
        self.window = bpy.context.window_manager.windows[0]
        self.area = max((area for area in self.window.screen.areas if area.type == "VIEW_3D"),
                        key=lambda area: area.width * area.height)
        self.at = self.centre = {"x": self.area.x + self.area.width // 2, "y": self.area.y + self.area.height // 2}

    def region(self, kind: str = "WINDOW") -> bpy.types.Region:
        return next(region for region in self.area.regions if region.type == kind)

    def context(self):
        """Operators that are called in it run in the viewport."""
        return bpy.context.temp_override(window=self.window, area=self.area, region=self.region())

    def point(self, x: int, y: int) -> None:
        """Move the mouse to a place in the window."""
        self.at = {"x": x, "y": y}
        self.window.event_simulate("MOUSEMOVE", "NOTHING", **self.at)

    def move(self, x: int = 0, y: int = 0) -> None:
        """Move the mouse by so much."""
        self.point(self.at["x"] + x, self.at["y"] + y)

    def press(self, key: str, **held: bool) -> None:
        for value in ("PRESS", "RELEASE"):
            self.window.event_simulate(key, value, **self.at, **held)

    def click(self, x: int, y: int) -> Iterator[float]:
        self.point(x, y)
        yield 0.3
        self.press("LEFTMOUSE")

    def write(self, words: str) -> Iterator[float]:
        """Type words, letter by letter."""
        for letter in words:
            key = KEYS.get(letter, letter.upper())
            self.window.event_simulate(key, "PRESS", unicode=letter, **self.at)
            self.window.event_simulate(key, "RELEASE", **self.at)
            yield 0.05

    def search(self, words: str) -> Iterator[float]:
        """Find an operator by F3 and press Enter."""
        self.point(**self.centre)
        yield 0.3
        self.press("F3")
        yield 0.8
        yield from self.write(words)
        yield 1.2


def waiting(done: Callable[[], object], what: str, seconds: float = 60.0) -> Iterator[float]:
    """Until something is so."""
    end = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < end, f"After {seconds:.0f} s still not so: {what}."
        yield 0.1
    yield 0.5


def turned_to_tab(screen: Screen) -> bool:
    """Choose the extension's tab; a sidebar has none before it is drawn."""
    try:
        screen.region("UI").active_panel_category = "Reflection"
    except AttributeError:
        return False
    return True


def built_zip() -> Path:
    """The extension as it is given to artists, in a folder of its own."""
    folder = Path(tempfile.mkdtemp())
    subprocess.run([bpy.app.binary_path, "--factory-startup", "--command", "extension", "build",
                    "--source-dir", str(ROOT), "--output-dir", str(folder)], check=True, stdout=subprocess.DEVNULL)
    return next(folder.glob("*.zip"))


def install() -> None:
    """Install the zip and switch the extension on."""
    bpy.ops.extensions.package_install_files(filepath=str(built_zip()), repo="user_default", enable_on_install=True)


def room_opened(shading: str = "SOLID", percentage: int = 25) -> Generator[float, None, Screen]:
    """Install the extension, open the sample room, look through its camera, and return the screen."""
    screen = Screen()
    screen.point(**screen.centre)
    yield 1.0
    screen.press("ESC")
    install()
    yield 1.0
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "room.blend"), load_ui=False)
    yield 2.0
    screen = Screen()
    space = screen.area.spaces.active
    space.region_3d.view_perspective, space.shading.type = "CAMERA", shading
    bpy.context.scene.render.resolution_percentage = percentage
    bpy.ops.ed.undo_push(message="Opened")
    return screen


def sidebar_opened(screen: Screen) -> Iterator[float]:
    """Open the sidebar by N, and choose the extension's tab."""
    screen.point(**screen.centre)
    yield 0.3
    screen.press("N")
    yield 1.0
    yield from waiting(lambda: turned_to_tab(screen), "the tab Reflection", 20.0)


def settled(name: str, seconds: float = 30.0) -> Iterator[float]:
    """Take a picture once nothing moves any more: shaders are compiled, panels have opened."""
    end, before = time.monotonic() + seconds, b""
    while time.monotonic() < end:
        yield 1.0
        now = subprocess.run(["import", "-window", "root", "rgb:-"], check=True, capture_output=True).stdout
        if now == before:
            break
        before = now
    shot(name)


def shot(name: str) -> None:
    """Take a picture of the whole screen."""
    SHOTS.mkdir(parents=True, exist_ok=True)
    subprocess.run(["import", "-window", "root", str(SHOTS / f"{name}.png")], check=True)


def run(steps: Callable[[], Iterator[float]]) -> None:
    """Go through `steps`, then leave."""
    going = steps()

    def step() -> float | None:
        try:
            return next(going)
        except StopIteration:
            leave(0)
        except BaseException:
            traceback.print_exc()
            shot("failed")
            leave(1)
        return None
    bpy.app.timers.register(step, first_interval=2.0, persistent=True)


def leave(status: int) -> None:
    """End the process with a status."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
