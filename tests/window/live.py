"""Live in a real window: what it does while keys and the mouse move the camera, and the viewport itself.

    blender --enable-event-simulate --python tests/window/live.py

from the folder of this repository; the extension is taken from there, and not from the preferences. The script

1. opens the sphere, generates by the operator, opens the sidebar, and switches Live on (the operator of the button);
2. presses G and drags the camera with the mouse, takes a picture in the middle and one after the click, one at rest;
3. presses Ctrl-Z and takes one at rest; then starts *Generate* while Live still works on a drag and ends it by ESC,
   cancels a drag half way, and undoes and redoes drags while Live is at work on them; at rest each time Live's result
   must be that of a new *Generate*;
4. plays frames over a sphere that has been given keys;
5. keeps the viewport's view right and orbits with the numpad's keys;
6. opens the file anew with Live on, and quits.

Pictures and `live.json` with what was counted go to the folder WINDOW_SHOTS, build/window where that is not set.
"""
import importlib
import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import ROOT, SHOTS, Screen, run, shot, waiting

sys.path.insert(0, str(ROOT.parent))
package = importlib.import_module(ROOT.name)
switch = importlib.import_module(f"{ROOT.name}.addon.live.switch")
told: dict = {}


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
    package.register()
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "sphere.blend"), load_ui=False)
    yield 2.0
    screen = Screen()
    yield from begun(screen)
    yield from dragged(screen)
    yield from disturbed(screen)
    yield from played()
    yield from orbited(screen)
    (SHOTS / "live.json").write_text(json.dumps(told, indent=1))
    # the timer that is to go on is one that lives through the opening of files
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    yield 2.0
    assert switch.updater is None and not bpy.app.timers.is_registered(switch._tick)


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
    shot("live_1_begun")


def dragged(screen):
    camera = bpy.context.scene.camera
    select_camera()
    yield from resting()
    place, started = camera.location.copy(), time.monotonic()
    before = switch.updater.updates["followed"]
    screen.press("G")
    for number in range(40):
        screen.move(x=4, y=1)
        yield 0.05
        if number == 25:
            shot("live_2_dragging")
    screen.press("LEFTMOUSE")
    found = note("dragged", started)
    found["followed_a_second"] = (found["updates"]["followed"] - before) / found["seconds"]
    # how many there were a second is told, not judged: the window of this machine may draw slowly
    assert camera.location != place and found["updates"]["followed"] > before + 5
    shot("live_3_dropped")
    yield from resting()
    note("rest", started)
    shot("live_4_rest")

    screen.press("Z", ctrl=True)
    yield from resting()
    camera = bpy.context.scene.camera
    assert (camera.location - place).length < 1e-5, "Ctrl-Z has not brought the camera back."
    note("undone", time.monotonic())
    shot("live_5_undone")


def right():
    """What the result shows is what a new one would show, to the last bit."""
    result = next(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION")

    def points():
        values = [0.0] * (3 * len(result.data.vertices))
        result.data.attributes["position"].data.foreach_get("vector", values)
        return values
    before, place = points(), result.location.copy()
    live = bpy.context.window_manager.reflection_mesh_live
    live.on = False
    bpy.ops.reflection_mesh.clear()
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    result = next(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION")
    assert (points(), result.location) == (before, place), "Live at rest is not what Generate makes."
    select_camera()
    live.on = True
    yield from resting()


def select_camera():
    camera = bpy.context.scene.camera
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    camera.select_set(True)
    bpy.context.view_layer.objects.active = camera
    bpy.ops.ed.undo_push(message="Camera selected")


def drag(screen, x, end="LEFTMOUSE"):
    """Drag the selected camera, and drop it at once."""
    screen.point(**screen.centre)
    screen.press("G")
    for _ in range(6):
        screen.move(x=x)
        yield 0.05
    screen.press(end)
    yield 0.05


def disturbed(screen):
    camera = bpy.context.scene.camera
    place = camera.location.copy()
    # another operator of ours begins while Live is at work on the camera's new place
    bpy.context.scene.reflection_mesh.tolerance = 0.02
    yield from drag(screen, 8)
    with screen.context():
        bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT")
    yield 0.5
    assert screen.window.modal_operators and switch.is_busy(), "Generate has ended before it could disturb."
    updates = dict(switch.updater.updates)
    yield 1.0
    assert switch.updater.updates == updates or not switch.is_busy(), "Live worked beside Generate."
    screen.press("ESC")
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Generate after ESC")
    bpy.context.scene.reflection_mesh.tolerance = 0.5
    yield from resting()
    note("beside Generate", time.monotonic())
    yield from right()

    # a drag that is taken back half way
    camera = bpy.context.scene.camera
    before = camera.location.copy()
    yield from drag(screen, 8, "ESC")
    yield from resting()
    assert (bpy.context.scene.camera.location - before).length < 1e-5, "ESC has not brought the camera back."
    yield from right()

    # undo and redo in the middle of what Live makes of it
    for number in range(4):
        yield from drag(screen, 6)
        screen.press("Z", ctrl=True)
        yield (0.0, 0.1, 0.3, 0.6)[number]
        screen.press("Z", ctrl=True, shift=True)
        yield (0.3, 0.0, 0.6, 0.1)[number]
    yield from resting()
    assert (bpy.context.scene.camera.location - place).length > 0.1
    yield from right()
    note("undone on the way", time.monotonic())
    shot("live_5_disturbed")


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
            shot("live_6_playing")
    assert note("played", started)["updates"]["followed"] > before
    yield from resting()
    shot("live_7_played")


def orbited(screen):
    bpy.context.window_manager.reflection_mesh_live.eye = "VIEW"
    screen.press("NUMPAD_5")
    yield from resting()
    before, started = switch.updater.updates["followed"], time.monotonic()
    for number in range(6):
        screen.press("NUMPAD_6")
        yield 0.3
        if number == 4:
            shot("live_8_orbiting")
    assert note("orbited", started)["updates"]["followed"] > before
    yield from resting()
    shot("live_9_orbited")


run(steps)
