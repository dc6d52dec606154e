"""The picture of Live in the documents: a window in which the camera is dragged, as a GIF of its screenshots.

    blender --enable-event-simulate --python tools/live_picture.py

from the folder of this repository, on an X screen with ImageMagick (`make live-picture` has one). It opens the sphere,
generates, switches Live on, presses G and drags the camera with the mouse.
"""
import importlib
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "window"))

import bpy
import hands
from hands import ROOT

sys.path.insert(0, str(ROOT.parent))
package = importlib.import_module(ROOT.name)
switch = importlib.import_module(f"{ROOT.name}.addon.live.switch")
TARGET = ROOT / "docs" / "pictures" / "live.gif"
FRAMES, STEP = 14, 9    # moves of the mouse, of so many pixels
RESTING = 120           # hundredths of a second at both ends
WIDTH, COLOURS = 720, 64


def steps():
    hands.SHOTS = Path(tempfile.mkdtemp())
    package.register()
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "sphere.blend"), load_ui=False)
    yield 2.0
    screen = hands.Screen()
    screen.move()
    yield 1.0
    screen.press("ESC")
    yield 0.5
    with screen.context():
        bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", select_alone=True)
        shown(screen)
    yield from hands.waiting(lambda: hands.turned_to_tab(screen), "the tab Reflection", 20.0)
    camera = bpy.context.scene.camera
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    camera.select_set(True)
    bpy.context.view_layer.objects.active = camera
    bpy.ops.reflection_mesh.live()
    yield from hands.waiting(lambda: switch.updater.at_rest, "at rest")
    yield from hands.settled("00")
    screen.press("G")
    for number in range(1, FRAMES + 1):
        screen.move(x=STEP, y=-STEP // 4)
        done = switch.updater.updates["followed"]
        yield from hands.waiting(lambda done=done: switch.updater.updates["followed"] > done, "an update")
        hands.shot(f"{number:02}")
    screen.press("LEFTMOUSE")
    yield from hands.waiting(lambda: switch.updater.at_rest, "at rest")
    yield from hands.settled(f"{FRAMES + 1:02}")
    written(screen)


def shown(screen: hands.Screen) -> None:
    """The viewport through the camera, in the materials' colours, with the sidebar."""
    space = screen.area.spaces.active
    space.shading.type, space.region_3d.view_perspective = "MATERIAL", "CAMERA"
    space.shading.use_scene_world = space.shading.use_scene_lights = True
    space.show_region_ui, space.show_region_toolbar = True, False
    space.overlay.show_outline_selected = False


def written(screen: hands.Screen) -> None:
    """The screenshots as a GIF of the viewport alone."""
    area = screen.area
    top = screen.window.height - area.y - area.height
    frames = sorted(map(str, hands.SHOTS.glob("[0-9][0-9].png")))
    subprocess.run(["convert", "-delay", str(RESTING), frames[0], "-delay", "12", *frames[1:-1], "-delay", str(RESTING),
                    frames[-1], "-crop", f"{area.width}x{area.height}+{area.x}+{top}", "+repage", "-resize",
                    str(WIDTH), "+dither", "-colors", str(COLOURS), "-loop", "0", "-layers", "optimize", str(TARGET)],
                   check=True)


hands.run(steps)
