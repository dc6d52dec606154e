"""Every way in, pressed by hand in a real window: what an artist does in the first ten minutes.

    blender --enable-event-simulate --python tests/window/ways_in.py

from the folder of this repository. The script builds and installs the extension as a zip, into preferences that are
thrown away (BLENDER_USER_RESOURCES), opens the room, and

1. opens the sidebar by N, chooses the tab, and clicks *Generate Reflection*;
2. undoes it by Ctrl-Z and does it again by Shift-Ctrl-Z;
3. starts another one, finer, and presses ESC half way;
4. finds *Light Reflection* by F3, which Cycles renders beside the window, or bakes on the objects in bands, and *Clear
   Reflections*;
5. opens the last operator's panel by F9;
6. bakes frames, found by F3, into a folder chosen in the file browser, ends that by ESC, and goes on with the same keys
   (where Blender was built without USD, after the grey button has said so, with a stand-in for its writing alone);
7. generates by the button in Object properties, switches Live on and off by its button while the camera moves, and
   generates by the menu's letter;
8. asks every operator and panel of the extension whether it can run, in every editor and in every mode.

Pictures go to the folder WINDOW_SHOTS, build/window where that is not set.
"""
import importlib
import re
import struct
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import Screen, room_opened, run, settled, shot, sidebar_opened, waiting
from polls import polls_of_the_extension

GENERATE = 129  # pixels below the upper end of the sidebar, at the resolution scale of 1
LIVE = 260      # the same of Live, where a mirror is active
PANEL = 266  # the panel in Object properties, above the window's lower end
PANEL_GENERATE = 153  # its first button
FRAMES = 4  # that are baked
MODES = ("EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "OBJECT")


def results() -> list:
    return [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]


def steps():
    screen = yield from room_opened("MATERIAL", 50)
    yield from sidebar_opened(screen)
    yield from settled("1_tab")
    yield from click(screen, GENERATE)
    yield from waiting(results, "a reflection")
    yield from settled("2_generated")
    assert bpy.context.view_layer.objects.active == results()[0]
    assert any("Preview" in slot.material.name for slot in results()[0].material_slots)

    screen.point(**screen.centre)
    screen.press("Z", ctrl=True)
    yield from waiting(lambda: not results(), "no reflection after Ctrl-Z")
    screen.press("Z", ctrl=True, shift=True)
    yield from waiting(results, "the reflection after Shift-Ctrl-Z")

    yield from stopped_by_escape(screen)
    yield from light_and_clear(screen)
    yield from baked(screen)
    yield from elsewhere(screen)
    yield from everywhere(screen)


def baked(screen: Screen):
    """Frames into the folder that the file browser is given, ended by ESC, and the rest by the same keys."""
    scene, folder = bpy.context.scene, Path(tempfile.mkdtemp())
    scene.frame_end, scene.reflection_mesh.light_samples = FRAMES, 1
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.type == "MESH")
    bpy.context.view_layer.objects.active = bpy.data.objects["Golden Ball"]
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    yield 0.5
    if not bpy.app.build_options.usd:
        grey_without_usd(screen)
        stand_in_for_usd()

    def done() -> int:
        return len(list(folder.glob("reflection frames/Frame.*.json")))
    yield from bake_into(screen, folder, "8_bake")
    yield from waiting(done, "a frame", 120.0)
    shot("9_baking")

    def ended() -> bool:
        # while Cycles renders a key that nobody pressed does not end it
        screen.press("ESC")
        return not screen.window.modal_operators
    yield from waiting(ended, "the end of baking after ESC", 60.0)
    kept = done()
    assert 0 < kept < FRAMES, f"ESC came after {kept} frames."
    assert not any(obj.reflection_mesh.role == "REFLECTION" for obj in scene.objects), "ESC has left something."
    stamps = {file: file.stat().st_mtime_ns for file in folder.glob("**/Frame.*.json")}
    yield from bake_into(screen, folder, "10_bake_again")
    yield from waiting(lambda: done() == FRAMES, "all frames", 240.0)
    yield from waiting(lambda: not screen.window.modal_operators, "the end of baking")
    assert all(file.stat().st_mtime_ns == stamp for file, stamp in stamps.items()), "Frames were made twice."
    assert [obj.name for obj in results()] == ["Golden Ball Reflection"]
    shot("11_baked")
    bpy.ops.reflection_mesh.clear()


def grey_without_usd(screen: Screen) -> None:
    """Linux distributions build Blender without USD, and without Alembic: the button is grey, and says why."""
    with screen.context():
        assert not bpy.ops.reflection_mesh.bake.poll()
        try:
            bpy.ops.reflection_mesh.bake("INVOKE_DEFAULT")
        except RuntimeError as error:
            assert "cannot write USD files, nor play them" in str(error), error
        else:
            raise AssertionError("Baking began without USD.")


def stand_in_for_usd() -> None:
    """So that keys, browser, progress and ESC are tried all the same: files that are none take the place of meshes.
    What is in real ones is looked at in tests/addon/frames."""
    package = next(name for name in bpy.context.preferences.addons.keys() if name.endswith("reflection_mesh"))
    write, bake, button = (importlib.import_module(f"{package}.addon.{name}") for name in (
        "frames.write_frame", "operators.bake_frames.bake", "operators.bake_frames.bake_operator"))
    write.writes_usd = bake.writes_usd = button.writes_usd = lambda: True
    write._export = lambda context, mesh, matrix, path: Path(path).write_bytes(
        b"PXR-USDC" + bytes(8) + struct.pack("<q", 24) + b"none")


def bake_into(screen: Screen, folder: Path, name: str):
    """Find the operator by F3, choose a folder, and begin."""
    yield from screen.search("bake reflection")
    screen.press("RET")
    yield from waiting(lambda: browser(screen) is not None, "a file browser", 20.0)
    area = browser(screen)
    assert area.spaces.active.params.filename == "reflection frames", area.spaces.active.params.filename
    area.spaces.active.params.directory = str(folder).encode() + b"/"
    yield 1.0
    shot(name)
    screen.point(area.x + area.width // 2, area.y + area.height // 2)
    yield 0.5
    screen.press("RET")


def browser(screen: Screen) -> bpy.types.Area | None:
    return next((area for area in screen.window.screen.areas if area.type == "FILE_BROWSER"), None)


def click(screen: Screen, below: int):
    """Press the button so many pixels below the upper end of the sidebar."""
    sidebar = screen.region("UI")
    yield from screen.click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - below)


def stopped_by_escape(screen: Screen):
    before = fingerprint(results()[0])
    bpy.context.scene.reflection_mesh.tolerance = 0.005
    bpy.context.view_layer.objects.active = bpy.data.objects["Golden Ball"]
    yield 1.0
    yield from click(screen, GENERATE)
    yield 1.0
    assert "REFLECTION_MESH_OT_generate" in [operator.bl_idname for operator in screen.window.modal_operators]
    shot("3_half_way")
    screen.press("ESC")
    yield 1.5
    yield from settled("4_escaped")
    assert not screen.window.modal_operators
    assert fingerprint(results()[0]) == before, "ESC has left something."
    bpy.context.scene.reflection_mesh.tolerance = 0.5


def fingerprint(result: bpy.types.Object) -> tuple:
    return result.name, len(result.data.polygons), len(result.data.vertices), result.reflection_mesh.seconds


def own_to_the_user() -> tuple:
    preferences = bpy.context.preferences
    return preferences.is_dirty, preferences.view.render_display_type, len(bpy.context.window_manager.windows)


def light_and_clear(screen: Screen):
    before = own_to_the_user()
    yield from screen.search("light reflection")
    shot("5_search")
    screen.press("RET")
    beside: list = []

    def lit() -> bool:
        beside.append(bpy.app.is_job_running("RENDER"))
        return results()[0].reflection_mesh.light_material is not None
    yield from waiting(lit, "light", 120.0)
    assert any(beside), "The window waited for Cycles."
    assert own_to_the_user() == before, "Rendering has opened a window, or changed the preferences."
    yield from settled("6_lit")
    screen.point(**screen.centre)
    yield 0.5
    screen.press("F9")
    yield 1.0
    screen.move(x=5, y=-5)
    yield 1.0
    yield from settled("7_last_operator")
    screen.press("ESC")
    yield 1.0
    yield from light_again(screen)
    yield from screen.search("clear reflections")
    screen.press("RET")
    yield from waiting(lambda: not results(), "no reflection after clearing")
    assert not any("Reflection" in image.name for image in bpy.data.images)


def light_again(screen: Screen):
    """ESC is heard while Cycles renders the light; then it is made to its end."""
    bpy.context.scene.reflection_mesh.light_samples = 4
    for stopped in (True, False):
        yield from screen.search("light reflection")
        screen.press("RET")
        if stopped:
            yield 1.0
            screen.press("ESC")
            yield from waiting(lambda: not screen.window.modal_operators, "the end of light after ESC", 20.0)
            assert results()[0].reflection_mesh.light_material is None
            continue
        yield from waiting(lambda: results()[0].reflection_mesh.light_material is not None, "light", 300.0)
    yield from settled("7b_lit_again")


def ball_active() -> None:
    """All selected, and the mirror active."""
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.type == "MESH" and obj.reflection_mesh.role != "REFLECTION")
    bpy.context.view_layer.objects.active = bpy.data.objects["Golden Ball"]


def elsewhere(screen: Screen):
    """Buttons in Object properties and the menu, and Live by its button."""
    # the result alone was selected, and is gone
    ball_active()
    editor = next(area for area in screen.window.screen.areas if area.type == "PROPERTIES")
    editor.spaces.active.context = "OBJECT"
    yield 1.0
    with bpy.context.temp_override(window=screen.window, area=editor):
        bpy.ops.screen.screen_full_area()
    yield 2.0
    # the header of the extension's panel, which is closed at first
    full = screen.window.screen.areas[0]
    yield from screen.click(full.x + 80, PANEL)
    yield 1.5
    yield from settled("12_object_properties")
    yield from screen.click(full.x + full.width // 2, PANEL_GENERATE)
    yield from waiting(results, "a reflection by the button in Object properties")
    with bpy.context.temp_override(window=screen.window, area=screen.window.screen.areas[0]):
        bpy.ops.screen.back_to_previous()
    yield 1.5
    yield from live_by_its_button(screen)
    ball_active()
    before = made_at()
    with screen.context():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_reflection_mesh" if hasattr(bpy.types, "VIEW3D_MT_reflection_mesh")
                             else "REFLECTION_MESH_MT_menu")
    yield 1.0
    yield from settled("13_menu")
    # the letter that is underlined
    screen.press("G")
    yield from waiting(lambda: not screen.window.modal_operators and made_at() != before, "the menu's Generate")
    with screen.context():
        bpy.ops.reflection_mesh.clear()
    ball_active()
    yield 0.5


def made_at() -> tuple:
    """What a new result changes."""
    return (results()[0].data.session_uid, len(results()[0].data.vertices), results()[0].reflection_mesh.seconds)


def live_by_its_button(screen: Screen):
    """On, a moving camera that the reflection follows, and off."""
    live, scene = bpy.context.window_manager.reflection_mesh_live, bpy.context.scene
    ball_active()
    yield 1.0
    yield from click(screen, LIVE)
    yield from waiting(lambda: live.on, "Live, by its button", 10.0)

    def shape() -> tuple:
        return tuple(results()[0].data.vertices[0].co)
    yield 3.0
    before = shape()
    scene.camera.location.x += 0.2
    yield from waiting(lambda: shape() != before, "a reflection that follows the camera", 30.0)
    yield from settled("14_live_by_its_button")
    yield from click(screen, LIVE)
    yield from waiting(lambda: not live.on, "the end of Live, by its button", 10.0)


def editors_of(area: bpy.types.Area) -> list[str]:
    """Every kind of editor, those that share a type told apart, as Blender lists them where it refuses a name."""
    try:
        area.ui_type = "NONE SUCH"
    except TypeError as error:
        found = re.findall(r"'(\w+)'", str(error).partition(" not found in ")[2])
    assert {"VIEW_3D", "UV", "IMAGE_EDITOR", "ShaderNodeTree", "GeometryNodeTree", "DOPESHEET"} <= set(found), found
    return found


def everywhere(screen: Screen):
    """Every poll of an operator or a panel, in every editor and in every mode: none may fail."""
    polls = polls_of_the_extension()
    told, editors = {}, editors_of(screen.area)
    for mode in MODES:
        with screen.context():
            bpy.ops.object.mode_set(mode=mode)
        for editor in editors:
            screen.area.ui_type = editor
            with bpy.context.temp_override(window=screen.window, area=screen.area):
                for name, cls in polls.items():
                    told[mode, editor, name] = cls.poll(bpy.context)
        screen.area.type = "VIEW_3D"
        yield 0.3
    button = "REFLECTION_MESH_OT_generate"
    assert told["OBJECT", "VIEW_3D", button] and not told["EDIT", "VIEW_3D", button]
    print(f"{len(told)} polls of {len(polls)} operators and panels in {len(editors)} editors.", flush=True)


run(steps)
