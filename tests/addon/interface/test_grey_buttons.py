"""Buttons that are grey say why, in the sentence that a run would have said."""
from __future__ import annotations

from itertools import product
from pathlib import Path
from types import SimpleNamespace

import bpy
import interface_words
import parts
import pytest
from drawn_panels import pair


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    return pair(blank)


def in_edit_mode() -> None:
    bpy.ops.object.mode_set(mode="EDIT")


def without_camera() -> None:
    bpy.context.scene.camera = None


def with_nothing_selected() -> None:
    parts.select()


def without_lamp() -> None:
    bpy.data.objects.remove(bpy.data.objects["Point"])
    # what emits and is selected may be one
    bpy.data.objects["Box"].data.materials.clear()


def with_a_camera_active() -> None:
    bpy.context.view_layer.objects.active = bpy.context.scene.camera


def options(name: str, folder: Path) -> dict:
    return {"filepath": str(folder / "out.png")} if name in {"bake", "compare", "print_sheet"} else {}


@pytest.mark.parametrize(("obstacle", "names"), [
    (in_edit_mode, ("generate", "light", "bake", "clear", "compare", "mirror_uvs")),
    (without_camera, ("generate", "light", "bake", "compare", "mirror_uvs")),
    (with_nothing_selected, ("generate", "bake", "compare", "mirror_uvs", "print_sheet", "caustics")),
    (without_lamp, ("caustics",)),
    (with_a_camera_active, ("print_sheet",)),
])
def test_a_grey_button_says_what_a_run_would(scene, room, tmp_path, monkeypatch, obstacle, names):
    if "caustics" in names:
        bpy.ops.object.light_add(type="POINT")
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    if "print_sheet" in names:
        kept, mesh = room("addon.anamorphosis"), bpy.data.objects["Mirror"].data
        mesh.uv_layers.new(name=kept.UV_MAP)
        mesh.attributes.new(kept.SEEN, "BOOLEAN", "FACE")
    if "light" in names:
        result = parts.generate()
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
        assert result
    assert all(getattr(bpy.ops.reflection_mesh, name).poll() for name in names)
    obstacle()
    try:
        assert not any(getattr(bpy.ops.reflection_mesh, name).poll() for name in names)
        told = {name: parts.refusal(getattr(bpy.ops.reflection_mesh, name), **options(name, tmp_path))
                for name in names}
        monkeypatch.setattr(room("addon.operators.polls"), "passes", lambda *_: True)
        assert told == {name: parts.refusal(getattr(bpy.ops.reflection_mesh, name), **options(name, tmp_path))
                        for name in names}
        # Blender cuts off what is longer
        assert all(len(sentence.encode()) < 200 for sentence in told.values())
    finally:
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")


def test_update_is_grey_where_nothing_is_kept_right(scene, room, monkeypatch):
    """Not in the background: scripts may update to be sure."""
    update, polls = bpy.ops.reflection_mesh.update, room("addon.operators.polls")
    assert update.poll()
    monkeypatch.setattr(polls, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    assert not update.poll() and parts.refusal(update) == "No reflection is stale."
    parts.generate()
    assert update.poll()


def test_light_without_a_reflection_is_grey(scene, room):
    assert not bpy.ops.reflection_mesh.light.poll()
    assert "generate one first" in parts.refusal(bpy.ops.reflection_mesh.light)


def test_clear_is_grey_where_nothing_is_left_to_clear(scene, room, monkeypatch):
    """Not so while a window still has to be brought back; and scripts in the background may clear to be sure."""
    clear, mirror, polls = bpy.ops.reflection_mesh.clear, bpy.data.objects["Mirror"], room("addon.operators.polls")
    assert clear.poll() and clear() == {"CANCELLED"}
    monkeypatch.setattr(polls, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    assert not clear.poll() and parts.refusal(clear) == "The scene has no reflection to clear."
    parts.generate()
    assert clear.poll() and clear() == {"FINISHED"} and not clear.poll()
    mirror.reflection_mesh.camera_hidden = True
    assert clear.poll()
    mirror.reflection_mesh.camera_hidden = False
    # of crowds a run tells
    monkeypatch.setattr(polls, "LOOKED_THROUGH", 2)
    assert clear.poll() and clear() == {"CANCELLED"}


def test_roles_and_results_need_no_selection(scene):
    parts.generate()
    parts.select()
    bpy.context.view_layer.objects.active = bpy.data.objects["Mirror Reflection"]
    assert bpy.ops.reflection_mesh.generate.poll()
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.generate.poll()
    bpy.data.objects["Mirror"].reflection_mesh.role = "MIRROR"
    assert bpy.ops.reflection_mesh.generate.poll()


def test_mirror_uvs_of_a_mirror_alone_are_grey(scene):
    """They are written on what is chosen: a reflection shows all that is there, and a map would change it."""
    box, mirror = bpy.data.objects["Box"], bpy.data.objects["Mirror"]
    mirror.data.materials.clear()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    operator = bpy.ops.reflection_mesh.mirror_uvs
    parts.select(mirror)
    assert bpy.ops.reflection_mesh.generate.poll() and not operator.poll()
    assert parts.refusal(operator).startswith("Nothing to reflect in 'Mirror': select the objects to reflect")
    box.reflection_mesh.role = "DIFFUSE"
    assert operator.poll()
    box.reflection_mesh.role = "AUTO"
    parts.select(box, mirror)
    assert operator.poll() and operator() == {"FINISHED"}


def test_a_button_that_is_grey_says_what_a_run_would(blank, room):
    """Whatever is selected, whatever its role and its material, in all combinations: with one object that is no mirror,
    as in a new file, the button is grey, and it is never grey where a run would find a mirror."""
    reading = room("addon.reading")
    ball, box, lamp = parts.add("uv_sphere", "Ball"), parts.add("cube", "Box"), None
    bpy.ops.object.light_add()
    lamp = blank.object
    ball.data.materials.append(parts.material("Chrome", "GLOSSY"))
    result = parts.add("plane", "Result")
    result.reflection_mesh.role = "REFLECTION"
    kinds: dict = {}
    for roles in product(("AUTO", "MIRROR", "DIFFUSE", "IGNORE"), repeat=2):
        ball.reflection_mesh.role, box.reflection_mesh.role = roles
        for mirror, chosen in product((None, ball, box), product((False, True), repeat=4)):
            result.reflection_mesh.mirror = mirror
            selected = [obj for obj, is_one in zip((ball, box, lamp, result), chosen) if is_one]
            for active in (None, box, lamp):
                parts.select(*selected)
                blank.view_layer.objects.active = active
                told = room("addon.operators.polls").has_mirror(blank)
                kinds[bool(told), len(selected)] = True
                if told:
                    with pytest.raises(room("core").ReflectionError) as refused:
                        reading.choose(blank)
                    assert str(refused.value) == told
    assert {(True, 0), (True, 1), (False, 1), (False, 2)} <= set(kinds)
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert [obj.name for obj in bpy.context.selected_objects] == ["Cube"]
    assert not bpy.ops.reflection_mesh.generate.poll() and parts.refusal() == reading.NO_MIRROR
    bpy.ops.object.select_all(action="SELECT")
    assert not bpy.ops.reflection_mesh.generate.poll()


def test_polls_do_not_look_through_crowds(scene, room, monkeypatch):
    """Which would take longer than a redraw may; a run tells then."""
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.generate.poll() and not bpy.ops.reflection_mesh.light.poll()
    monkeypatch.setattr(room("addon.operators.polls"), "LOOKED_THROUGH", 2)
    assert bpy.ops.reflection_mesh.generate.poll() and bpy.ops.reflection_mesh.light.poll()
    assert parts.refusal().startswith("No mirror")


@pytest.mark.parametrize("context", [SimpleNamespace(), SimpleNamespace(scene=None), SimpleNamespace(view_layer=None),
                                     SimpleNamespace(scene=None, view_layer=None, mode="EDIT_MESH")])
def test_polls_take_contexts_that_lack_everything(context):
    for cls in interface_words.classes():
        if issubclass(cls, bpy.types.Operator) and cls.bl_idname != "reflection_mesh.preset_add":
            assert cls.poll(context) is False
