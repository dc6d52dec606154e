"""Bad input: one sentence that says what to do, and nothing has changed."""
import bpy
import numpy as np
import parts
import pytest


@pytest.fixture
def scene(blank):
    """A wall mirror, active, and a cube in front of it; a bystander."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    parts.add("cube", "Bystander", location=(9.0, 0.0, 0.0))
    mirror = parts.add_wall_mirror()
    parts.select(cube, mirror)
    return mirror, cube


def test_the_scene_itself_is_good(scene):
    assert len(parts.generate().data.polygons) > 0


def test_nothing_selected(scene):
    parts.select()
    assert "No mirror" in parts.refusal()


def test_only_the_mirror_selected(scene):
    parts.select(scene[0])
    assert "select" in parts.refusal()


def test_no_camera(scene):
    bpy.context.scene.camera = None
    assert "camera" in parts.refusal()


def test_camera_is_no_camera(scene):
    bpy.context.scene.camera = scene[1]
    assert "'Box' is no camera" in parts.refusal()


def test_panoramic_camera(scene):
    bpy.context.scene.camera.data.type = "PANO"
    assert "panoramic" in parts.refusal()


def test_camera_scaled_to_nothing(scene):
    bpy.context.scene.camera.scale = 0.0, 0.0, 0.0
    bpy.context.view_layer.update()
    assert "camera" in parts.refusal()


def test_mirror_without_faces(scene):
    scene[0].data.clear_geometry()
    assert "'Mirror' has no faces" in parts.refusal()


def test_diffuse_without_faces(scene):
    scene[1].data.clear_geometry()
    assert "'Box' has no faces" in parts.refusal()


def test_mirror_is_a_source(scene):
    result = parts.generate()
    result.reflection_mesh.sources.add().object = scene[0]
    parts.select(result)
    assert "both the mirror and a source" in parts.refusal()


def test_result_without_its_mirror(scene):
    result = parts.generate()
    bpy.data.objects.remove(scene[0])
    parts.select(result)
    assert "is gone: clear it" in parts.refusal()


def test_result_without_its_sources(scene):
    result = parts.generate()
    bpy.data.objects.remove(scene[1])
    parts.select(result)
    assert "Nothing to reflect" in parts.refusal()


def test_eye_on_the_mirror(scene):
    scene[0].location = bpy.context.scene.camera.location
    bpy.context.view_layer.update()
    parts.refusal()


def test_mirror_behind_the_eye(scene):
    scene[0].location.y = -20.0
    bpy.context.view_layer.update()
    parts.refusal()


def test_mirror_without_an_area(scene):
    scene[0].scale = 0.0, 0.0, 0.0
    bpy.context.view_layer.update()
    parts.refusal()


def test_diffuse_without_an_area(scene):
    scene[1].scale = 0.0, 0.0, 0.0
    bpy.context.view_layer.update()
    parts.refusal()


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("which", [0, 1])
def test_coordinates_that_are_no_numbers(scene, value, which):
    positions = parts.attribute(scene[which], "position")
    positions[0, 0] = value
    scene[which].data.attributes["position"].data.foreach_set("vector", positions.ravel())
    scene[which].data.update()
    assert f"'{scene[which].name}' has a vertex" in parts.refusal()


@pytest.mark.parametrize("which", [0, 1])
def test_transform_that_is_no_number(scene, which):
    scene[which].delta_location = np.nan, 0.0, 0.0
    bpy.context.view_layer.update()
    assert f"'{scene[which].name}' has a transform" in parts.refusal()


def test_zero_normals_are_replaced_by_flat_ones(scene):
    """A degenerate triangle beside good ones has a normal of zero: the others reflect all the same."""
    mirror = scene[0]
    mesh = bpy.data.meshes.new("Odd")
    mesh.from_pydata([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0)], [],
                     [(0, 1, 2, 3), (4, 5, 6)])
    mirror.data = mesh
    bpy.context.view_layer.update()
    place = parts.attribute(parts.generate(), "mirror_position")
    assert len(place) and np.allclose(place[:, 1], 1.0, atol=1e-6)


def test_scene_wholly_outside_the_view(scene):
    scene[1].location = 0.0, -1.5, 5000.0
    bpy.context.view_layer.update()
    assert "sees none of the reflected objects" in parts.refusal()


def test_mirrors_that_show_nothing_are_left_out(scene, room):
    """Two of three mirrors show nothing: the third gets its result, and each of the others its sentence."""
    high = parts.add("plane", "High", location=(0.0, 1.0, 500.0))
    behind = parts.add("plane", "Back", size=4.0, location=(0.0, 9.0, 1.0), rotation=(0.0, np.pi / 2, 0.0))
    chosen = room("addon.reading.roles").Participants([high, behind, scene[0]], [scene[1]], [])
    steps = room("addon.operators.generate").generation(bpy.context, chosen, room("core").Settings())
    outcome = room("addon.command_line.verbs").announced(steps)
    assert [obj.name for obj, _ in outcome.results] == ["Mirror Reflection"]
    assert [remark.split(":")[0] for remark in outcome.remarks] == ["High", "Back"]
    assert "High Reflection" not in bpy.data.objects and "Back Reflection" not in bpy.data.objects


def test_edit_mode(scene):
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert "Object Mode" in parts.refusal()
        assert bpy.context.mode == "EDIT_MESH"
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("hide", ["hide_render", "hide_viewport"])
@pytest.mark.parametrize(("which", "words"), [(0, "mirror 'Mirror' is hidden"), (1, "object 'Box' is hidden")])
def test_hidden_objects(scene, hide, which, words):
    scene[0].reflection_mesh.role = "MIRROR"
    scene[1].reflection_mesh.role = "DIFFUSE"
    setattr(scene[which], hide, True)
    bpy.context.view_layer.update()
    assert words in parts.refusal()


def test_hidden_by_the_eye_icon(scene):
    scene[0].reflection_mesh.role = "MIRROR"
    scene[1].reflection_mesh.role = "DIFFUSE"
    scene[1].hide_set(True)
    assert "'Box' is hidden" in parts.refusal()


def test_excluded_collection(scene):
    scene[0].reflection_mesh.role = "MIRROR"
    scene[1].reflection_mesh.role = "DIFFUSE"
    shelf = bpy.data.collections.new("Shelf")
    bpy.context.scene.collection.children.link(shelf)
    shelf.objects.link(scene[1])
    bpy.context.scene.collection.objects.unlink(scene[1])
    result = parts.generate()
    bpy.context.view_layer.layer_collection.children["Shelf"].exclude = True
    parts.select(result)
    assert "'Box' is hidden" in parts.refusal()


def test_clear_without_results(scene):
    before = parts.state()
    assert bpy.ops.reflection_mesh.clear() == {"CANCELLED"}
    assert parts.state() == before


def test_clear_in_edit_mode(scene):
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert "Object Mode" in parts.refusal(bpy.ops.reflection_mesh.clear)
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_an_earlier_result_survives_a_refusal(scene):
    result = parts.generate()
    faces = len(result.data.polygons)
    scene[1].data.clear_geometry()
    parts.select(result)
    parts.refusal()
    assert len(result.data.polygons) == faces


@pytest.mark.parametrize("which", [0, 1])
def test_coordinates_where_blenders_numbers_end(scene, which):
    scene[which].scale = (1e30,) * 3
    bpy.context.view_layer.update()
    assert f"'{scene[which].name}' reaches further than" in parts.refusal()
