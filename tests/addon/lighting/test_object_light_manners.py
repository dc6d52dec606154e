"""Light that stays with the objects: what it keeps, stops at, is saved with and leaves behind."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import leaves_no_trace, lit_state, outdated, scene_of


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS") == {"FINISHED"}


def test_another_mesh_does_not_show_it(blank, room):
    scene_of(blank)
    result = parts.generate(tolerance=4.0)
    light(1)
    bpy.data.objects["Box"].modifiers.new("Finer", "SUBSURF").levels = 1
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert outdated(room, result)
    assert all(slot.link == "DATA" for slot in result.material_slots)


def test_what_is_hidden_meanwhile_takes_no_part(blank, room):
    """A result remembers it for when it is shown again; its light stays what it is."""
    wall = scene_of(blank)
    other = parts.add("cube", "Other", size=0.5, location=(-1.0, -1.5, 1.0))
    other.hide_render = True
    parts.select(bpy.data.objects["Box"], other, wall)
    result = parts.generate(tolerance=4.0)
    assert [source.object.name for source in result.reflection_mesh.sources] == ["Box", "Other"]
    light(1)
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert not outdated(room, result)
    assert {slot.material for slot in result.material_slots} == {result.reflection_mesh.light_material}
    other.hide_render = False
    parts.generate(tolerance=4.0)
    assert outdated(room, result) and len(set(parts.attribute(result, "source_object"))) == 2
    bpy.data.objects["Box"].hide_render = True
    with pytest.raises(RuntimeError, match="shows an object that is hidden now"):
        light(1)


@pytest.mark.thorough
@pytest.mark.parametrize(("stage", "times"), [("Reading", 1), ("Measuring", 1), ("Copying", 1), ("Copying", 2),
                                              ("Baking light", 1), ("Baking light", 2), *(("Writing", times)
                                                                                          for times in range(1, 6))])
def test_stopped_after_any_step_it_leaves_no_trace(blank, room, stage, times):
    scene_of(blank, "Alpha")
    result = parts.generate()
    before = lit_state()
    steps = room("addon.operators.light").lighting(blank, [result], 1, "OBJECTS")
    while times:
        times -= next(steps)[1].startswith(stage)
    steps.close()
    assert lit_state() == before


@pytest.mark.thorough
@pytest.mark.parametrize("failing", ["kept_map", "new_object_material", "show_object_light"])
def test_an_error_leaves_no_trace(blank, room, monkeypatch, failing):
    leaves_no_trace(blank, room, monkeypatch, ("addon.operators.made_light", failing), "OBJECTS")


@pytest.mark.thorough
def test_clear_takes_it_away(blank):
    scene_of(blank, "Alpha", "Tint")
    before = parts.state()
    parts.generate()
    light(1)
    # one kind of light takes the other's place
    bpy.ops.reflection_mesh.light(samples=1, kind="PICTURE")
    assert "Reflection Light" not in bpy.data.meshes
    light(1)
    assert {image.name for image in bpy.data.images} - {"Render Result"} == {"Reflection Light"}
    assert "Reflection Light" in bpy.data.meshes
    bpy.ops.reflection_mesh.clear()
    assert parts.state()["data"] == before["data"]


def test_what_moves_is_lit_on_the_objects(blank):
    scene_of(blank)
    result = parts.generate(tolerance=4.0)
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.reflection_mesh.light_map is None
    blank.scene.camera.keyframe_insert("location", frame=1)
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.reflection_mesh.light_map is not None


def test_of_many_objects_the_light_is_made_in_the_picture(blank, room):
    """Each would be baked by itself, half a second and more: a shelf of instanced books took two minutes."""
    scene_of(blank)
    mirror, box = bpy.data.objects["Mirror"], bpy.data.objects["Box"]
    few = room("addon.baking.seen_sources").FEW
    # at two seconds and more for each, a still is lit within a minute
    assert few <= 24
    books = [bpy.data.objects.new(f"Book {number}", box.data) for number in range(few)]
    for number, book in enumerate(books):
        book.location, book.scale = (-2.0 + 4.0 * number / few, -3.0, 2.0), (0.02, 0.1, 0.2)
        blank.scene.collection.objects.link(book)
    blank.scene.camera.keyframe_insert("location", frame=1)
    for shown, kept in ((books[:few - 2], True), (books, False)):
        parts.select(*shown, box, bpy.data.objects["Floor"], mirror)
        result = parts.generate()
        assert room("addon.baking").are_few([result]) == kept
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert result.reflection_mesh.light_map is None and result.reflection_mesh.light_material is not None


def test_it_is_saved_with_the_file(blank, tmp_path):
    scene_of(blank)
    parts.generate(tolerance=4.0)
    light(1)
    size = len(bpy.data.meshes["Reflection Light"].vertices)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lit.blend"))
    result = bpy.data.objects["Mirror Reflection"]
    assert len(result.reflection_mesh.light_map.vertices) == size
    shown = result.reflection_mesh.light_material
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert {slot.material for slot in result.material_slots} == {shown}


def test_points_are_not_lit_so(blank):
    scene_of(blank)
    parts.generate(method="POINTS")
    with pytest.raises(RuntimeError, match="choose Light: Picture"):
        light(1)


def test_images_of_the_mirror_s_own_are_the_user_s(blank):
    """Also where nothing but the material of the light still shows them."""
    wall = scene_of(blank, "", "Fresnel")
    own = bpy.data.images.new("Scratches", 4, 4)
    tree = wall.material_slots[0].material.node_tree
    tree.nodes.new("ShaderNodeTexImage").image = own
    parts.generate()
    light(1)
    bpy.data.materials.remove(wall.material_slots[0].material)
    bpy.ops.reflection_mesh.clear()
    assert "Scratches" in bpy.data.images and "Reflection Light" not in bpy.data.images


def test_linked_objects_are_baked_under_their_names(blank, tmp_path):
    scene_of(blank, "Random")
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.objects["Box"]})
    bpy.data.objects.remove(bpy.data.objects["Box"])
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Box"]
    box = wanted.objects[0]
    blank.scene.collection.objects.link(box)
    blank.view_layer.update()
    parts.select(box, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    result = parts.generate()
    light(1)
    assert result.reflection_mesh.light_map is not None and not box.hide_render and box.name == "Box"


@pytest.mark.thorough
@pytest.mark.parametrize(("mirror", "placement", "told"), [
    ("Fresnel", "SURFACE", True), ("Fresnel", "VIRTUAL", True), ("Fresnel", "LAYERED", False),
    ("Tint", "SURFACE", False)])
def test_where_mirrors_shadow_their_own_matte_part_that_is_said(blank, capsys, mirror, placement, told):
    """The matte part of a result is lit by lamps as it lies: on the mirror, or behind it, in the mirror's shadow."""
    scene_of(blank, "", mirror)
    parts.generate(placement=placement)
    light(1)
    assert ("The matte part of 'Mirror' is lit where the reflection lies" in capsys.readouterr().out) == told


@pytest.mark.thorough
@pytest.mark.parametrize(("placement", "wide", "told"), [
    ("VIRTUAL", False, True), ("VIRTUAL", True, False), ("LAYERED", False, False)])
def test_what_a_window_does_not_show_any_more_is_said(blank, capsys, placement, wide, told):
    """The sky that a curved mirror shows beside a wall, where the wall does not fill it."""
    scene_of(blank)
    ball = parts.add("uv_sphere", "Ball", radius=0.5, location=(0.0, 0.5, 1.0))
    ball.data.materials.append(bpy.data.objects["Mirror"].active_material)
    ball.reflection_mesh.role = "MIRROR"
    for name in ("Mirror", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    around = [bpy.data.objects["Box"]]
    if wide:
        around.append(parts.add("uv_sphere", "Room", radius=20.0))
    parts.select(*around, ball)
    parts.generate(placement=placement)
    light(1)
    assert ("what 'Ball' would show beside what is reflected" in capsys.readouterr().out) == told
