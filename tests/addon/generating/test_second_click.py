"""Pressing the button again: on the mirror, on results, on copies of them, after changes by hand."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from mathutils import Matrix
from reflected_box import middle, moved, reflected_box, results


@pytest.fixture
def scene(blank):
    return reflected_box()


def test_the_mirror_alone_updates_its_result(scene):
    mirror, cube, result = scene
    moved(cube)
    parts.select(mirror)
    assert parts.generate() == result and results() == ["Mirror Reflection"]
    shown = parts.attribute(result, "reflected_position")[:, 0]
    assert (shown.min(), shown.max()) == pytest.approx((-0.1, 0.9), abs=1e-6)


def test_a_plain_object_that_was_made_a_mirror_does_too(scene):
    mirror, cube, result = scene
    mirror.data.materials.clear()
    before = middle(result)
    moved(cube)
    parts.select(mirror)
    assert parts.generate() == result and middle(result)[0] > before[0] + 0.3


def test_a_mirror_alone_shows_what_is_there(scene):
    """As mirrors do, and nobody has to read what to select; what is hidden, or said to be left out, is not there."""
    mirror, cube, result = scene
    bpy.ops.reflection_mesh.clear()
    ball, *others = (parts.add("uv_sphere", name, location=(1.5, -1.5, 1.0))
                     for name in ("Ball", "Hidden", "Unseen", "Ignored"))
    others[0].hide_set(True)
    others[1].visible_glossy = False
    others[2].reflection_mesh.role = "IGNORE"
    parts.select(mirror)
    assert bpy.ops.reflection_mesh.generate.poll()
    made = parts.generate()
    assert {source.object for source in made.reflection_mesh.sources} == {cube, ball}
    # maps are written on nothing that was not chosen
    bpy.ops.reflection_mesh.clear()
    parts.select(mirror)
    assert "Nothing to reflect in 'Mirror'" in parts.refusal(bpy.ops.reflection_mesh.mirror_uvs)
    for obj in (cube, ball):
        obj.hide_render = True
    assert parts.refusal() == ("Nothing to reflect in 'Mirror': select the objects to reflect together with it, or set "
                               "their role to Reflected in the Reflection tab.")


def test_a_mirror_without_a_result_takes_what_roles_say(scene):
    mirror, cube, result = scene
    bpy.ops.reflection_mesh.clear()
    parts.add("uv_sphere", "Ball", location=(1.5, -1.5, 1.0))
    parts.select(mirror)
    cube.reflection_mesh.role = "DIFFUSE"
    assert [source.object for source in parts.generate().reflection_mesh.sources] == [cube]


def test_several_results_are_updated_at_once(scene):
    mirror, cube, result = scene
    # one of them seen in the other does not move as the cube does
    bpy.context.scene.reflection_mesh.depth = 1
    floor = parts.add("plane", "Floor", size=6.0)
    parts.select(cube, floor)
    floor.data.materials.append(mirror.data.materials[0])
    second = parts.generate()
    both, before = (result, second), [middle(result), middle(second)]
    moved(cube)
    parts.select(*both)
    parts.generate()
    assert all(middle(obj)[0] > earlier[0] + 0.3 for obj, earlier in zip(both, before))
    cube.reflection_mesh.role = "IGNORE"
    ball = parts.add("uv_sphere", "Ball", location=(0.0, -1.5, 1.0))
    parts.select(ball, floor)
    parts.generate()
    parts.select(*both)
    assert "show different objects" in parts.refusal()


def test_replaced_materials_stay(scene):
    mirror, cube, result = scene
    red, blue = parts.material("Red"), parts.material("Blue")
    made = result.data.materials[0]
    result.data.materials[0] = red
    moved(cube)
    parts.select(mirror)
    parts.generate()
    assert list(result.data.materials) == [red]
    slot = result.material_slots[0]
    slot.link, slot.material = "OBJECT", blue
    parts.generate()
    slot = result.material_slots[0]
    assert (slot.link, slot.material, result.data.materials[0]) == ("OBJECT", blue, red)
    # put back by hand, it is as if nothing had been
    slot.material, slot.link = None, "DATA"
    result.data.materials[0] = made
    parts.generate()
    assert list(result.data.materials) == [made] and result.material_slots[0].link == "DATA"


def test_a_replaced_preview_stays(scene):
    mirror, cube, result = scene
    cube.data.materials.append(parts.material("Second", "DIFFUSE"))
    cube.data.polygons[0].material_index = 1
    parts.select(cube, mirror)
    parts.generate(preview=True)
    slots = result.material_slots
    assert [slot.link for slot in slots] == ["OBJECT", "OBJECT"]
    slots[1].material = red = parts.material("Red")
    parts.generate()
    assert "Preview" in slots[0].material.name and (slots[1].link, slots[1].material) == ("OBJECT", red)


def test_a_replaced_material_that_has_no_place_any_more_is_told(scene, room):
    mirror, cube, result = scene
    result.data.materials[0] = parts.material("Red")
    group = result.vertex_groups.new(name="Chosen")
    group.add([0, 1], 1.0, "ADD")
    result.shape_key_add(name="Basis")
    cube.data.materials[0] = parts.material("Green")
    parts.select(mirror)
    outcome = generated(room)
    told, = [text for text in outcome.remarks if "lost" in text]
    assert all(what in told for what in ("shape keys", "vertex groups", "the material 'Red'"))
    assert result.data.materials[0].name == "Green" and result.data.shape_keys is None


def generated(room):
    module = room("addon.operators.generate")
    steps = module.generation(bpy.context, room("addon.reading").choose(bpy.context), room("core").Settings())
    return room("addon.faults").finished(steps)


@pytest.mark.parametrize("parented", [False, True])
def test_a_moved_result_stays_moved(scene, room, parented):
    mirror, cube, result = scene
    place = result.matrix_world.copy()
    if parented:
        result.parent, result.matrix_parent_inverse = mirror, mirror.matrix_world.inverted()
        mirror.location.x += 0.25
        bpy.context.view_layer.update()
        parts.select(mirror)
        parts.generate()
        bpy.context.view_layer.update()
        # it moves with its parent, which is no change by hand: it lies where the mirror is
        place = Matrix.Translation((0.25, 0.0, 0.0)) @ place
        assert np.allclose(result.matrix_world, place, atol=1e-6)
    by_hand = Matrix.Translation((0.0, 0.0, 2.0)) @ Matrix.Scale(2.0, 4)
    result.matrix_world = by_hand @ place
    result.name, result.hide_select = "My Own", True
    result.modifiers.new("Thick", "SOLIDIFY")
    for _ in range(2):
        mirror.location.x += 0.125
        bpy.context.view_layer.update()
        parts.select(mirror)
        outcome = generated(room)
        bpy.context.view_layer.update()
    expected = by_hand @ Matrix.Translation((0.25, 0.0, 0.0)) @ place
    if parented:
        # the parent took it along
        expected = Matrix.Translation((0.25, 0.0, 0.0)) @ by_hand @ place
    assert np.allclose(result.matrix_world, expected, atol=1e-5)
    assert result.hide_select and [modifier.name for modifier in result.modifiers] == ["Thick"]
    assert outcome.news == [
        "'My Own' stays moved, as you left it: clear it and generate again to have it on its mirror."]


def duplicated(result: bpy.types.Object, linked: bool) -> bpy.types.Object:
    """A copy of a result, 3 above it."""
    parts.select(result)
    bpy.ops.object.duplicate(linked=linked)
    copy = bpy.context.object
    copy.location.z += 3.0
    bpy.context.view_layer.update()
    return copy


@pytest.mark.parametrize("linked", [False, True])
def test_copies_are_updated_too(scene, room, linked):
    mirror, cube, result = scene
    copy = duplicated(result, linked)
    meshes = len(bpy.data.meshes)
    moved(cube)
    parts.select(mirror)
    outcome = generated(room)
    assert outcome.news == [f"Updated too, as a copy: {copy.name!r}."]
    assert (copy.data == result.data) == linked and len(bpy.data.meshes) == meshes
    for name in ("position", "reflected_position"):
        assert np.array_equal(parts.attribute(copy, name), parts.attribute(result, name))
    assert middle(result)[0] > 0.3 and (copy.location - result.location).z == pytest.approx(3.0)


@pytest.mark.parametrize("linked", [False, True])
def test_copies_are_lit_too(scene, room, monkeypatch, linked):
    mirror, cube, result = scene
    copy = duplicated(result, linked)
    parts.select(result)
    before = parts.state()
    light = room("addon.operators.light")
    with monkeypatch.context() as broken:
        broken.setattr(light, "light_results", lambda *_: 1 / 0)
        with pytest.raises(RuntimeError):
            bpy.ops.reflection_mesh.light(samples=1)
    assert parts.state() == before and (copy.data == result.data) == linked
    for _ in range(2):
        parts.select(result)
        bpy.ops.reflection_mesh.light(samples=1)
        for obj in (result, copy):
            assert obj.reflection_mesh.light_material is not None
            assert {slot.material for slot in obj.material_slots} == {obj.reflection_mesh.light_material}
        assert (copy.data == result.data) == linked
        assert len([mesh for mesh in bpy.data.meshes if "Reflection" in mesh.name]) == (1 if linked else 2)
        spots = [[tuple(round(value, 5) for value in spot.vector) for spot in obj.data.uv_layers["Reflection Light"].uv]
                 for obj in (result, copy)]
        assert spots[0] == spots[1]


def test_a_failure_brings_everything_back(scene, room, monkeypatch):
    mirror, cube, result = scene
    copy = duplicated(result, True)
    copy.data.materials[0] = parts.material("Red")
    moved(cube)
    parts.select(mirror)

    def failing(*_):
        raise OSError("no room")
    def state() -> tuple:
        return (parts.state(), middle(result).tolist(), [
            (obj.matrix_basis.copy(),
             *(tuple(getattr(obj.reflection_mesh, name)) for name in ("origin", "basis", "aside")),
             [entry.material for entry in obj.reflection_mesh.materials]) for obj in (result, copy)])
    mirror.location.x += 0.25
    bpy.context.view_layer.update()
    before = state()
    monkeypatch.setattr(room("addon.operators.write_results"), "show_for_camera", failing)
    monkeypatch.setattr(room("addon.operators.write_results"), "put_back_materials", failing)
    parts.refusal()
    assert state() == before and copy.data == result.data and copy.data.materials[0].name == "Red"
