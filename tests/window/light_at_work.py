"""While Light Reflection is at work, the rendered viewport and the panel show what they showed before.

    blender --enable-event-simulate --python tests/window/light_at_work.py

from the folder of this repository. The script opens the sidebar, generates, shows the viewport rendered by Cycles,
presses G and ESC, and lights. While Cycles works it asserts that the panel calls nothing stale and that no object has
changed. Pictures go to the folder WINDOW_SHOTS, build/window where that is not set: w2 and w3 show the same scene.
"""
import importlib
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import Screen, room_opened, run, settled, shot, sidebar_opened, waiting

FLAGS = ("hide_render", "visible_camera", "is_holdout", "is_shadow_catcher", "name")


def result() -> bpy.types.Object | None:
    return next((obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"), None)


def flags() -> list:
    return [[getattr(obj, name) for name in FLAGS] for obj in bpy.context.scene.objects]


def steps():
    screen = yield from room_opened()
    scene, space = bpy.context.scene, screen.area.spaces.active
    scene.render.engine, scene.cycles.preview_samples = "CYCLES", 4
    scene.reflection_mesh.light_samples = 64
    package = next(name for name in bpy.context.preferences.addons.keys() if name.endswith("reflection_mesh"))
    freshness = importlib.import_module(f"{package}.addon.freshness")
    yield from sidebar_opened(screen)
    yield from screen.search("generate reflection")
    screen.press("RET")
    yield from waiting(result, "a reflection")
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Generate")
    space.shading.type = "RENDERED"
    yield 15.0
    yield from settled("w1_generated", 60.0)
    before = flags()
    yield from screen.search("light reflection")
    screen.press("RET")
    yield from waiting(lambda: screen.window.modal_operators, "Light at work", 20.0)
    yield 8.0
    for number in range(3):
        shot(f"w2_at_work_{number}")
        assert screen.window.modal_operators, "Light was done too soon to be looked at."
        assert flags() == before, "Light has changed objects."
        assert freshness.why_stale(bpy.context, result()) == ""
        yield 3.0
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Light", 120.0)
    yield from settled("w3_lit", 60.0)
    assert flags() == before and freshness.why_light_differs(bpy.context, result()) == ""
    yield from dragged(screen, freshness)


def dragged(screen: Screen, freshness):
    """G and ESC leave the light as it is."""
    scene, camera = bpy.context.scene, bpy.context.scene.camera
    scene.view_layers[0].objects.active = camera
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    camera.select_set(True)
    screen.point(**screen.centre)
    yield 1.0
    screen.press("G")
    yield 0.5
    screen.move(x=60)
    yield 1.0
    shot("w4_dragged")
    screen.press("ESC")
    yield 2.0
    scene.view_layers[0].objects.active = result()
    assert freshness.why_light_differs(bpy.context, result()) == "", "G and ESC have made light outdated."
    yield from settled("w5_escaped", 60.0)


run(steps)
