"""Live in a real window: what it does while keys and the mouse move the camera, and the viewport itself.

    blender --enable-event-simulate sample_blends/sphere.blend --python tests/window/live.py

from the folder of this repository; the extension is taken from there, and not from the preferences. The script

1. generates by the operator, opens the sidebar at the tab Reflection, and presses Live (the operator of the button);
2. presses G and drags the camera with the mouse, takes a picture in the middle and one after the click, one at rest;
3. presses Ctrl-Z and takes one at rest, then plays frames over a sphere that has been given keys;
4. keeps the viewport's view right and orbits with the numpad's keys;
5. opens the file anew with Live on, and quits.

Pictures (`import`, of ImageMagick) and `live.json` with what was counted go to the folder WINDOW_SHOTS, `shots` where
that is not set. The exit status is 0 where all of it held.
"""
import importlib
import json
import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
SHOTS = Path(os.environ.get("WINDOW_SHOTS", "shots")).resolve()
sys.path.insert(0, str(ROOT.parent))
package = importlib.import_module(ROOT.name)
switch = importlib.import_module(f"{ROOT.name}.addon.live.switch")
told: dict = {}


class Screen:
    """The largest 3D viewport of the first window, and the hands before it."""

    def __init__(self):
        self.window = bpy.context.window_manager.windows[0]
        self.area = max((area for area in self.window.screen.areas if area.type == "VIEW_3D"),
                        key=lambda area: area.width * area.height)
        self.at = {"x": self.area.x + self.area.width // 2, "y": self.area.y + self.area.height // 2}

    def move(self, x=0, y=0):
        self.at = {"x": self.at["x"] + x, "y": self.at["y"] + y}
        self.window.event_simulate("MOUSEMOVE", "NOTHING", **self.at)

    def press(self, key, **held):
        self.window.event_simulate(key, "PRESS", **self.at, **held)
        self.window.event_simulate(key, "RELEASE", **self.at, **held)

    def context(self):
        region = next(region for region in self.area.regions if region.type == "WINDOW")
        return bpy.context.temp_override(window=self.window, area=self.area, region=region)


def shot(name):
    SHOTS.mkdir(parents=True, exist_ok=True)
    subprocess.run(["import", "-window", "root", str(SHOTS / f"{name}.png")], check=True)


def note(name, started):
    """What has been done since the last note."""
    updater = switch.updater
    told[name] = {"updates": dict(updater.updates), "milliseconds": updater.milliseconds, "told": updater.told,
                  "at_rest": updater.at_rest, "seconds": time.monotonic() - started}
    print(name, told[name], flush=True)
    return told[name]


def resting(limit=20.0):
    """Wait until Live is at rest."""
    end = time.monotonic() + limit
    yield 0.4
    while not switch.updater.at_rest:
        assert time.monotonic() < end, "Live does not come to rest."
        yield 0.1


def steps():
    screen = Screen()
    yield from begun(screen)
    yield from dragged(screen)
    yield from played()
    yield from orbited(screen)
    # the timer that is to go on is one that lives through the opening of files
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)


def begun(screen):
    screen.move()
    yield 1.0
    screen.press("ESC")
    yield 0.5
    with screen.context():
        space = screen.area.spaces.active
        space.shading.type, space.shading.color_type = "SOLID", "MATERIAL"
        space.overlay.show_outline_selected = False
        space.show_region_ui = True
        space.region_3d.view_perspective = "CAMERA"
        assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    yield 1.0
    sidebar = next(region for region in screen.area.regions if region.type == "UI")
    sidebar.active_panel_category = "Reflection"
    bpy.ops.ed.undo_push(message="Generated")
    bpy.ops.reflection_mesh.live()
    yield from resting()
    note("begun", time.monotonic())
    shot("1_begun")


def dragged(screen):
    camera = bpy.context.scene.camera
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    camera.select_set(True)
    bpy.context.view_layer.objects.active = camera
    bpy.ops.ed.undo_push(message="Camera selected")
    yield from resting()
    place, started = camera.location.copy(), time.monotonic()
    before = switch.updater.updates["followed"]
    screen.press("G")
    for number in range(40):
        screen.move(x=4, y=1)
        yield 0.05
        if number == 25:
            shot("2_dragging")
    screen.press("LEFTMOUSE")
    found = note("dragged", started)
    found["followed_a_second"] = (found["updates"]["followed"] - before) / found["seconds"]
    # how many there were a second is told, not judged: the window of this machine may draw slowly
    assert camera.location != place and found["updates"]["followed"] > before + 5
    shot("3_dropped")
    yield from resting()
    note("rest", started)
    shot("4_rest")

    screen.press("Z", ctrl=True)
    yield from resting()
    camera = bpy.context.scene.camera
    assert (camera.location - place).length < 1e-5, "Ctrl-Z has not brought the camera back."
    note("undone", time.monotonic())
    shot("5_undone")


def played():
    sphere = next(obj.reflection_mesh.mirror for obj in bpy.context.scene.objects
                  if obj.reflection_mesh.role == "REFLECTION")
    for frame, height in ((1, 0.0), (24, 0.6)):
        sphere.location.z += height
        sphere.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    yield from resting()
    started, before = time.monotonic(), switch.updater.updates["followed"]
    for frame in range(1, 25):
        bpy.context.scene.frame_set(frame)
        yield 0.05
        if frame == 15:
            shot("6_playing")
    assert note("played", started)["updates"]["followed"] > before
    yield from resting()
    shot("7_played")


def orbited(screen):
    bpy.context.window_manager.reflection_mesh_live.eye = "VIEW"
    screen.press("NUMPAD_5")
    yield from resting()
    before, started = switch.updater.updates["followed"], time.monotonic()
    for number in range(6):
        screen.press("NUMPAD_6")
        yield 0.3
        if number == 4:
            shot("8_orbiting")
    assert note("orbited", started)["updates"]["followed"] > before
    yield from resting()
    shot("9_orbited")


def after_opening(*_):
    held = switch.updater is None and not bpy.app.timers.is_registered(switch._tick)
    print("opened anew: Live is", "off" if held else "on", flush=True)
    finish(0 if held else 1)


def finish(status):
    (SHOTS / "live.json").write_text(json.dumps(told, indent=1))
    sys.stdout.flush()
    os._exit(status)


def step():
    try:
        return next(run)
    except StopIteration:
        after_opening()
    except BaseException:
        traceback.print_exc()
        shot("failed")
        finish(1)


package.register()
run = steps()
bpy.app.timers.register(step, first_interval=2.0, persistent=True)
