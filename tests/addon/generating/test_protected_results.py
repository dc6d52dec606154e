"""Results made by a button: clicks in the viewport pass by them, they stay in place, and all that can be done with a
result can be done with its mirror selected."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

# without a window Blender invokes no operator: what a button switches on
PRESSED = {"generate": ("preview", "collect", "select_alone", "protect"), "caustics": ("protect",)}


def press(name: str, **options) -> None:
    """Run an operator as its button does."""
    pressed = dict.fromkeys(PRESSED.get(name, ()), True)
    assert getattr(bpy.ops.reflection_mesh, name)("EXEC_DEFAULT", **pressed, **options) == {"FINISHED"}


def results() -> list:
    return [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]


def is_protected(obj: bpy.types.Object) -> bool:
    locks = (*obj.lock_location, *obj.lock_rotation, *obj.lock_scale)
    assert len(set(locks)) == 1 and locks[0] == obj.hide_select
    return obj.hide_select


@pytest.fixture
def scene(blank):
    """A box of a diffuse material before a wall mirror and a ball, both of mirror materials."""
    box = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    box.data.materials.append(parts.material("Paint", "DIFFUSE"))
    ball = parts.add("uv_sphere", "Ball", radius=0.5, location=(1.2, 0.0, 1.0))
    for mirror in (ball, parts.add_wall_mirror()):
        mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    bpy.ops.object.light_add(type="POINT", location=(0.0, -3.0, 3.0))
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 64, 48
    return blank


def test_what_a_button_makes_is_active_and_its_mirror_is_selected(scene):
    box, mirror = bpy.data.objects["Box"], bpy.data.objects["Mirror"]
    parts.select(box, mirror)
    press("generate")
    result, = results()
    assert scene.view_layer.objects.active == result and scene.selected_objects == [mirror]
    assert is_protected(result)
    # all that Blender selects passes by it
    bpy.ops.object.select_all(action="SELECT")
    assert result not in scene.selected_objects and mirror in scene.selected_objects
    # a script gets what it asks for
    bpy.ops.reflection_mesh.clear()
    parts.select(box, mirror)
    result = parts.generate()
    assert not is_protected(result) and result in scene.selected_objects


def test_earlier_results_are_protected_once_and_what_the_user_changes_stays(scene):
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    result = parts.generate()
    press("generate")
    assert results() == [result] and is_protected(result)
    result.hide_select, result.lock_location = False, (False, True, True)
    press("generate")
    assert not result.hide_select and tuple(result.lock_location) == (False, True, True)
    assert scene.selected_objects == [result]


def test_a_result_can_be_edited_while_it_is_protected(scene):
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    press("generate")
    result, = results()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.hide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert all(face.hide for face in result.data.polygons)
    assert bpy.ops.object.material_slot_add() == {"FINISHED"}


def test_select_reflection(scene):
    box, mirror = bpy.data.objects["Box"], bpy.data.objects["Mirror"]
    parts.select(box, mirror)
    assert not bpy.ops.reflection_mesh.select.poll()
    press("generate")
    result, = results()
    for active in (mirror, result):
        result.hide_select = True
        parts.select(active)
        assert bpy.ops.reflection_mesh.select() == {"FINISHED"}
        assert scene.view_layer.objects.active == result and scene.selected_objects == [result]
    # it is selected as anything else is, and still stays in its place
    parts.select(box)
    assert not bpy.ops.reflection_mesh.select.poll()
    parts.select(result)
    place = np.array(result.matrix_world)
    assert np.array_equal(np.array(result.matrix_world), place) and all(result.lock_location)


def test_operators_take_a_selected_mirror_for_its_result(scene):
    """Two mirrors of three pressed at once: what follows means these two."""
    box, ball, mirror = (bpy.data.objects[name] for name in ("Box", "Ball", "Mirror"))
    other = parts.add("plane", "Other", size=6.0)
    other.data.materials.append(mirror.data.materials[0])
    parts.select(box, other)
    press("generate")
    parts.select(box, ball, mirror)
    press("generate")
    made = {obj.reflection_mesh.mirror: obj for obj in results()}
    assert set(made) == {ball, mirror, other} and set(scene.selected_objects) == {ball, mirror}
    press("light", samples=1)
    assert [obj.reflection_mesh.light_material is not None for obj in map(made.get, (ball, mirror, other))] == [
        True, True, False]
    # again, by the mirror alone: as it was made
    sources = [source.object for source in made[ball].reflection_mesh.sources]
    parts.select(ball)
    press("generate")
    assert [source.object for source in made[ball].reflection_mesh.sources] == sources
    assert len(results()) == 3
    press("clear")
    assert {obj.reflection_mesh.mirror for obj in results()} == {mirror, other}


def test_an_active_result_is_meant_where_nothing_is_selected(scene):
    """Check the state after a click in the Outliner. Otherwise *Clear* would remove all results."""
    box, ball, mirror = (bpy.data.objects[name] for name in ("Box", "Ball", "Mirror"))
    parts.select(box, ball, mirror)
    press("generate")
    keep, = (obj for obj in results() if obj.reflection_mesh.mirror == mirror)
    gone, = (obj for obj in results() if obj.reflection_mesh.mirror == ball)
    parts.select(gone)
    assert not scene.selected_objects
    press("clear")
    assert results() == [keep]


def test_caustics_are_protected_too(scene):
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    press("caustics")
    light, = (obj for obj in scene.scene.objects if obj.reflection_mesh.role == "CAUSTICS")
    assert is_protected(light)
    light.hide_select = False
    press("caustics")
    assert not light.hide_select
    light.hide_select = True
    parts.select(bpy.data.objects["Mirror"])
    press("clear")
    assert not [obj for obj in scene.scene.objects if obj.reflection_mesh.role == "CAUSTICS"]


def test_writing_that_fails_leaves_the_protection_as_it_was(scene, room, monkeypatch):
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    result = parts.generate()

    def fail(*_):
        raise RuntimeError("no")
    monkeypatch.setattr(room("addon.operators.write_results"), "show_previews", fail)
    with pytest.raises(RuntimeError):
        press("generate")
    assert not is_protected(result) and not result.reflection_mesh.protected


def test_buttons_switch_on_what_is_tested_here(room):
    """Told of the classes, as invoking needs a window: tests/window presses the buttons."""
    made = {"generate": room("addon.operators.generate").REFLECTION_MESH_OT_generate,
            "caustics": room("addon.operators.caustics.caustics_operator").REFLECTION_MESH_OT_caustics,
            "bake": room("addon.operators.bake_frames.bake_operator").REFLECTION_MESH_OT_bake}
    assert {name: cls.on_if_pressed for name, cls in made.items()} == {**PRESSED, "bake": ("protect",)}


def test_what_plays_baked_frames_is_protected_too(moving, tmp_path):
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", filepath=str(tmp_path / "frames"), frames="1", samples=0,
                                        protect=True) == {"FINISHED"}
    result, = results()
    assert is_protected(result) and result.modifiers
