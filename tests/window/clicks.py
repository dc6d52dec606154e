"""Clicks and keys around a result, in a real window: they mean the mirror, and never tear the reflection off.

    blender --enable-event-simulate --python tests/window/clicks.py

from the folder of this repository. With the sample `room` the script

1. generates by the button: the result is active, the ball selected, and the panel's button switches the viewport to
   Material Preview;
2. clicks on the ball, presses G, and selects all by a box: the ball is selected and moved, the reflection is not;
3. clicks the result in the Outliner and edits its mesh;
4. selects it by *Select Reflection*, after which clicks give it, and G leaves it in its place;
5. generates caustics, and clicks on the floor under them;
6. reads the Info editor: it shows no records.

Pictures go to the folder WINDOW_SHOTS, build/window where that is not set.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import Screen, room_opened, run, settled, sidebar_opened, waiting

GENERATE = 129  # pixels below the upper end of the sidebar, at the resolution scale of 1
SHADING = 354   # the same of the button that switches the viewport's shading
ROW = 108       # pixels from the window's upper end to the result's row in the Outliner
FLOOR = (-150, -160)    # pixels from the middle of the viewport to a place on the floor


def steps():
    screen = yield from room_opened()
    space = screen.area.spaces.active
    yield from sidebar_opened(screen)
    yield from settled("clicks_1_before")
    yield from pressed(screen, GENERATE)
    yield from waiting(lambda: results("REFLECTION"), "a reflection")
    yield from settled("clicks_2_generated")
    assert (active(), selected()) == ("Golden Ball Reflection", ["Golden Ball"]), (active(), selected())
    yield from pressed(screen, SHADING)
    yield from waiting(lambda: space.shading.type == "MATERIAL", "Material Preview by the panel's button", 10.0)
    yield from settled("clicks_3_material_preview")
    space.shading.type = "SOLID"
    yield from clicked_and_moved(screen)
    yield from edited(screen)
    yield from selected_by_the_button(screen)
    yield from caustics_on_the_floor(screen)
    told = info(screen)
    own = [line for line in told.splitlines() if "reflection_mesh." in line]
    assert len(own) >= 3 and not any("{" in line for line in own), told


def clicked_and_moved(screen: Screen):
    result, ball = results("REFLECTION")[0], bpy.data.objects["Golden Ball"]
    yield from screen.click(**screen.centre)
    yield 0.5
    assert (active(), selected()) == ("Golden Ball", ["Golden Ball"]), (active(), selected())
    before = [tuple(map(tuple, obj.matrix_world)) for obj in (result, ball)]
    yield from grabbed(screen)
    after = [tuple(map(tuple, obj.matrix_world)) for obj in (result, ball)]
    assert after[0] == before[0] and after[1] != before[1], "G has moved the reflection, or not the ball."
    yield from settled("clicks_4_moved")
    screen.press("Z", ctrl=True)
    yield 1.0
    # all that a box meets
    screen.point(screen.centre["x"] - 250, screen.centre["y"] - 250)
    yield 0.3
    screen.press("B")
    yield 0.3
    screen.window.event_simulate("LEFTMOUSE", "PRESS", **screen.at)
    yield 0.2
    screen.move(500, 500)
    yield 0.2
    screen.window.event_simulate("LEFTMOUSE", "RELEASE", **screen.at)
    yield 0.5
    assert "Golden Ball" in selected() and "Golden Ball Reflection" not in selected(), selected()


def grabbed(screen: Screen):
    """Press G, move the mouse, and confirm."""
    screen.press("G")
    yield 0.3
    screen.move(60, 40)
    yield 0.3
    screen.press("RET")
    yield 0.5


def edited(screen: Screen):
    """The Outliner makes the result active, and Tab edits it."""
    outliner = next(area for area in screen.window.screen.areas if area.type == "OUTLINER")
    # it has scrolled to what was active
    region = next(region for region in outliner.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=screen.window, area=outliner, region=region):
        bpy.ops.view2d.scroll_up(deltay=100, page=True)
        bpy.ops.view2d.scroll_up(deltay=100, page=True)
    yield 0.5
    yield from screen.click(outliner.x + 140, screen.window.height - ROW)
    yield 0.7
    yield from settled("clicks_5_outliner")
    assert active() == "Golden Ball Reflection", active()
    screen.point(**screen.centre)
    yield 0.3
    for mode in ("EDIT", "OBJECT"):
        screen.press("TAB")
        yield 1.0
        assert results("REFLECTION")[0].mode == mode
    assert results("REFLECTION")[0].hide_select


def selected_by_the_button(screen: Screen):
    yield from screen.search("select reflection")
    screen.press("RET")
    yield 1.0
    assert (active(), selected()) == ("Golden Ball Reflection", ["Golden Ball Reflection"]), (active(), selected())
    yield from settled("clicks_6_selected")
    result = results("REFLECTION")[0]
    before = tuple(map(tuple, result.matrix_world))
    screen.point(**screen.centre)
    yield from grabbed(screen)
    assert tuple(map(tuple, result.matrix_world)) == before, "G has torn the reflection off."
    yield from screen.click(**screen.centre)
    yield 0.5
    assert active() == "Golden Ball Reflection", active()
    result.hide_select = True


def caustics_on_the_floor(screen: Screen):
    with screen.context():
        bpy.ops.reflection_mesh.caustics("INVOKE_DEFAULT")
    yield from waiting(lambda: results("CAUSTICS") and not screen.window.modal_operators, "caustics", 120.0)
    x, y = FLOOR
    yield from screen.click(screen.centre["x"] + x, screen.centre["y"] + y)
    yield 0.7
    yield from settled("clicks_7_caustics")
    assert results("CAUSTICS") and not active().endswith("Caustics") and "Caustics" not in active(), active()
    assert active() in {"Tiles", "Floor"}, active()


def results(role: str) -> list:
    return [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == role]


def active() -> str:
    return bpy.context.view_layer.objects.active.name


def selected() -> list[str]:
    return sorted(obj.name for obj in bpy.context.view_layer.objects if obj.select_get())


def pressed(screen: Screen, below: int):
    """Press the button so many pixels below the upper end of the sidebar."""
    sidebar = screen.region("UI")
    yield from screen.click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - below)


def info(screen: Screen) -> str:
    """All that the Info editor shows."""
    screen.area.type = "INFO"
    with bpy.context.temp_override(window=screen.window, area=screen.area, region=screen.area.regions[-1]):
        bpy.ops.info.select_all(action="SELECT")
        bpy.ops.info.report_copy()
    screen.area.type = "VIEW_3D"
    return bpy.context.window_manager.clipboard


run(steps)
