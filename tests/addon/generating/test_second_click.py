"""Pressing the button again: on the mirror, on results, on copies of them, by another camera, after changes by hand."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from mathutils import Matrix


@pytest.fixture
def scene(blank):
    """A box, a wall mirror with a mirror's material, and the reflection of one in the other."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "PRINCIPLED"))
    parts.select(cube, mirror)
    return mirror, cube, parts.generate()


def moved(cube) -> None:
    cube.location.x += 0.4
    bpy.context.view_layer.update()


def middle(result) -> np.ndarray:
    return parts.attribute(result, "reflected_position").mean(axis=0)


def second_camera() -> bpy.types.Object:
    bpy.ops.object.camera_add(location=(2.0, -6.0, 1.0), rotation=(1.45, 0.0, 0.3))
    other = bpy.context.object
    other.name = "Other"
    other.select_set(False)
    return other


def results() -> list:
    return sorted(obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION")


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


def test_each_camera_has_a_result_of_its_own(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    mine = parts.attribute(result, "position").copy()
    other = second_camera()
    scene_.camera = other
    parts.select(cube, mirror)
    second = parts.generate()
    assert results() == ["Mirror Reflection", "Mirror Reflection Other"] and second.name == "Mirror Reflection Other"
    assert np.array_equal(parts.attribute(result, "position"), mine)
    assert (result.hide_render, second.hide_render) == (True, False)
    # in place, by whichever way
    for chosen in ([mirror], [second], [cube, mirror]):
        parts.select(*chosen)
        assert parts.generate() == second
    assert len(results()) == 2
    # who looks sees what is right for it
    scene_.camera = first
    bpy.context.view_layer.update()
    assert (result.hide_render, result.hide_viewport, second.hide_render) == (False, False, True)
    assert parts.attribute(result, "position").tolist() == mine.tolist()
    parts.select(mirror)
    assert parts.generate() == result


def test_what_the_user_hides_or_shows_stays_so(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    result.hide_render = False
    scene_.camera = other
    bpy.context.view_layer.update()
    assert not result.hide_render
    second.hide_render = True
    for camera in (first, other):
        scene_.camera = camera
        bpy.context.view_layer.update()
    assert second.hide_render and result.hide_render
    # a camera without results sees what was seen before
    scene_.camera = second_camera()
    bpy.context.view_layer.update()
    assert second.hide_render and result.hide_render


def test_markers_cut_to_the_result_of_their_camera(scene, tmp_path):
    """In the frames of a render too, each of which is as that camera's still."""
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    scene_.render.engine, scene_.cycles.samples, scene_.cycles.use_denoising = "CYCLES", 1, False
    scene_.render.resolution_x = scene_.render.resolution_y = 48
    scene_.render.resolution_percentage = 100
    cube.visible_glossy = False     # so that the mirror shows the box by its result alone

    def still(camera) -> np.ndarray:
        scene_.camera = camera
        bpy.context.view_layer.update()
        scene_.render.filepath = str(tmp_path / "still.png")
        bpy.ops.render.render(write_still=True)
        return pixels(tmp_path / "still.png")
    wanted = [still(other), still(first), still(other)]
    shown = result.hide_render, second.hide_render
    result.hide_render, second.hide_render = False, True
    bpy.context.view_layer.update()
    bpy.ops.render.render(write_still=True)
    assert (pixels(tmp_path / "still.png") != wanted[0]).any(), "The test cannot tell the results apart."
    result.hide_render, second.hide_render = shown
    scene_.frame_start, scene_.frame_end = 1, 3
    for frame, camera in enumerate((other, first, other), 1):
        scene_.timeline_markers.new(camera.name, frame=frame).camera = camera
    scene_.render.filepath = str(tmp_path / "cut_")
    bpy.ops.render.render(animation=True)
    for frame, picture in enumerate(wanted, 1):
        assert (pixels(tmp_path / f"cut_{frame:04}.png") == picture).all(), frame


def pixels(path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    try:
        return np.array(image.pixels)
    finally:
        bpy.data.images.remove(image)


def test_a_window_that_does_not_wait_for_renders_is_told_of_where_markers_cut(scene, room):
    mirror, cube, result = scene
    lacks, context = room("addon.operators.shortcomings").render_shortcomings, bpy.context
    first, other = context.scene.camera, second_camera()
    for frame, camera in enumerate((first, other), 1):
        context.scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    assert lacks(context, [mirror], [cube]) == []
    context.scene.camera = other
    parts.select(cube, mirror)
    parts.generate()
    assert [sentence[:26] for sentence in lacks(context, [mirror], [cube])] == ["Markers change the camera:"]
    context.scene.render.use_lock_interface = True
    assert lacks(context, [mirror], [cube]) == []


def test_a_window_is_one_for_its_camera(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    cube.location.y = -2.5
    parts.select(mirror)
    parts.generate(placement="VIRTUAL")
    assert not mirror.visible_camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    parts.generate()
    assert mirror.visible_camera
    scene_.camera = first
    bpy.context.view_layer.update()
    assert not mirror.visible_camera
    scene_.camera = other
    bpy.context.view_layer.update()
    assert mirror.visible_camera
    scene_.camera = first
    bpy.context.view_layer.update()
    bpy.data.objects.remove(result)
    bpy.context.view_layer.update()
    assert mirror.visible_camera


def test_a_result_of_an_earlier_version_belongs_to_the_scenes_camera(scene):
    mirror, _, result = scene
    result.reflection_mesh.camera = None
    parts.select(mirror)
    assert parts.generate() == result and result.reflection_mesh.camera == bpy.context.scene.camera


def test_a_result_of_a_deleted_camera_is_taken_over(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    bpy.data.objects.remove(second)
    bpy.data.objects.remove(first)
    parts.select(cube, mirror)
    assert parts.generate() == result and not result.hide_render


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


@pytest.mark.parametrize("kind", ["PICTURE", "OBJECTS"])
@pytest.mark.parametrize("linked", [False, True])
def test_copies_are_lit_too(scene, room, monkeypatch, linked, kind):
    mirror, cube, result = scene
    copy = duplicated(result, linked)
    parts.select(result)
    before = parts.state()
    light = room("addon.operators.light")
    with monkeypatch.context() as broken:
        broken.setattr(light, "_stay_linked", lambda *_: 1 / 0)
        with pytest.raises(RuntimeError):
            bpy.ops.reflection_mesh.light(samples=1, kind=kind)
    assert parts.state() == before and (copy.data == result.data) == linked
    for _ in range(2):
        parts.select(result)
        bpy.ops.reflection_mesh.light(samples=1, kind=kind)
        for obj in (result, copy):
            assert obj.reflection_mesh.light_material is not None
            assert {slot.material for slot in obj.material_slots} == {obj.reflection_mesh.light_material}
        assert (copy.data == result.data) == linked
        assert len([mesh for mesh in bpy.data.meshes if "Reflection" in mesh.name]) == (1 if linked else 2) + (
            kind == "OBJECTS")
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
