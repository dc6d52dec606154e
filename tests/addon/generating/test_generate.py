"""Generate on primitives: what the result is, against closed forms of the flat mirror and of linear interpolation."""
import json
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest

ATTRIBUTES = {
    "reflected_position": ("FLOAT_VECTOR", "POINT"), "mirror_position": ("FLOAT_VECTOR", "POINT"),
    "path_length": ("FLOAT", "POINT"), "image_parity": ("INT", "POINT"), "source_object": ("INT", "FACE"),
    "source_face": ("INT", "FACE"), "mirror_face": ("INT", "FACE"),
}
EYE = np.array([0.0, -6.0, 1.0])


@pytest.fixture
def sphere_scene(blank):
    """A mirror sphere over a floor with a cube beside it, all three selected, the sphere active."""
    sphere = parts.add("uv_sphere", "Ball", segments=24, ring_count=12, location=(0.0, 0.0, 1.0))
    bpy.ops.object.shade_smooth()
    sphere.data.materials.append(parts.material("Chrome", "GLOSSY"))
    cube = parts.add("cube", "Box", size=1.0, location=(2.0, -1.0, 0.5))
    cube.data.materials.append(parts.material("Red"))
    floor = parts.add("plane", "Floor", size=8.0)
    floor.data.materials.append(parts.material("White"))
    parts.select(cube, floor, sphere)
    return sphere, cube, floor


@pytest.fixture
def wall_scene(blank):
    """A wall mirror at y = 1 and one triangle in front of it that the camera sees mirrored."""
    mirror = parts.add_wall_mirror()
    triangle = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    parts.select(triangle, mirror)
    return mirror, triangle


def test_result_has_the_named_attributes(sphere_scene):
    sphere, cube, floor = sphere_scene
    result = parts.generate()
    assert result.name == "Ball Reflection" and result.type == "MESH"
    assert result.reflection_mesh.role == "REFLECTION"
    assert result.reflection_mesh.mirror == sphere
    assert {source.object for source in result.reflection_mesh.sources} == {cube, floor}
    found = {name: (result.data.attributes[name].data_type, result.data.attributes[name].domain)
             for name in ATTRIBUTES}
    assert found == ATTRIBUTES
    assert len(result.data.polygons) > 100
    assert all(isinstance(count, int) for count in json.loads(result.reflection_mesh.counts).values())
    assert tuple(result.reflection_mesh.resolution) == (256, 192)


def test_attributes_agree_with_each_other(sphere_scene):
    result = parts.generate(hidden_faces=True)
    reflected, place = (parts.attribute(result, name) for name in ("reflected_position", "mirror_position"))
    length = np.linalg.norm(reflected - place, axis=1)
    assert np.allclose(parts.attribute(result, "path_length"), length, atol=1e-5)
    assert set(parts.attribute(result, "image_parity")) <= {-1, 0, 1}
    # mirror places lie on the sphere's facets, a little inside its radius
    radius = np.linalg.norm(place - (0.0, 0.0, 1.0), axis=1)
    assert radius.max() < 1.0 + 1e-5 and radius.min() > np.cos(np.pi / 12)
    # each face shows the object that it names: the floor lies at z = 0, the cube elsewhere
    sources = [item.object.name for item in result.reflection_mesh.sources]
    on_floor = parts.attribute(result, "source_object") == sources.index("Floor")
    heights = np.abs(reflected[parts.corners(result), 2]).max(axis=1)
    assert on_floor.any() and (~on_floor).any() and heights[on_floor].max() < 1e-5
    inside = np.abs(reflected[parts.corners(result)[~on_floor]] - (2.0, -1.0, 0.5)).max(axis=2)
    assert np.allclose(inside, 0.5, atol=1e-5)
    faces = parts.attribute(result, "source_face")
    assert faces[on_floor].max() <= 1 and 2 <= faces[~on_floor].max() <= 11 and faces.min() >= 0
    assert -1 <= parts.attribute(result, "mirror_face").min()
    assert parts.attribute(result, "mirror_face").max() < len(bpy.data.objects["Ball"].data.loop_triangles)


def test_mesh_is_valid(sphere_scene):
    result = parts.generate()
    assert result.data.validate(verbose=True) is False
    assert not result.data.validate_material_indices()
    positions = parts.attribute(result, "position")
    assert np.isfinite(positions).all()


@pytest.mark.parametrize("placement", ["LAYERED", "SURFACE", "VIRTUAL"])
def test_flat_mirror_is_the_mirrored_triangle(wall_scene, placement):
    """Every vertex lies on the view ray through the mirrored point, whatever the placement."""
    result = parts.generate(placement=placement)
    reflected, place = (parts.attribute(result, name) for name in ("reflected_position", "mirror_position"))
    image = reflected * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)
    position = parts.attribute(result, "position") + np.array(result.location)
    towards = (image - EYE) / np.linalg.norm(image - EYE, axis=1, keepdims=True)
    for points in (position, place):
        along = np.einsum("ij,ij->i", points - EYE, towards)
        assert np.abs(EYE + along[:, None] * towards - points).max() < 2e-6
    assert np.abs(place[:, 1] - 1.0).max() < 1e-6
    if placement == "SURFACE":
        assert np.abs(position - place).max() < 1e-6
    if placement == "VIRTUAL":
        assert np.abs(position - image).max() < 2e-6
    if placement == "LAYERED":
        assert (position[:, 1] < 1.0).all()
    # the triangle is whole: its picture's area is that of its virtual image
    source = np.array([vertex.co for vertex in wall_scene[1].data.vertices]) * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)
    assert np.isclose(_area(position[parts.corners(result)]), _area(source[None]), rtol=1e-5)


def _area(triangles: np.ndarray) -> float:
    flat = (triangles - EYE)[..., [0, 2]] / (triangles - EYE)[..., [1]]
    edges = flat[:, 1:] - flat[:, :1]
    return np.abs(np.linalg.det(edges)).sum() / 2.0


def test_uv_and_colours_are_interpolated(wall_scene):
    mirror, triangle = wall_scene
    colour = triangle.data.color_attributes.new("Tint", "FLOAT_COLOR", "POINT")
    values = np.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]], dtype=np.float32)
    colour.data.foreach_set("color", values.ravel())
    byte = triangle.data.color_attributes.new("Bytes", "BYTE_COLOR", "CORNER")
    byte.data.foreach_set("color", values.ravel())
    result = parts.generate()
    source = np.array([vertex.co for vertex in triangle.data.vertices])
    reflected = parts.attribute(result, "reflected_position")[parts.corners(result)].reshape(-1, 3)
    weights = np.linalg.lstsq(np.vstack([source.T, np.ones(3)]), np.c_[reflected, np.ones(len(reflected))].T,
                              rcond=None)[0].T
    assert np.allclose(parts.attribute(result, "UVMap"), weights @ [(0, 0), (1, 0), (0, 1)], atol=1e-5)
    assert np.allclose(parts.attribute(result, "Tint"), weights @ values, atol=1e-5)
    assert result.data.attributes["Bytes"].data_type == "BYTE_COLOR"
    assert np.allclose(parts.attribute(result, "Bytes"), weights @ values, atol=0.01)
    assert result.data.uv_layers.active.name == "UVMap"


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_colours_and_uvs_that_are_no_numbers_become_zero(wall_scene, method, domain):
    """The second corner's alone: what lies between the others stays as it was."""
    _, triangle = wall_scene
    colour = triangle.data.color_attributes.new("Tint", "FLOAT_COLOR", domain)
    values = np.array([[1, 0, 0, 1], [np.nan, np.inf, -np.inf, 1], [0, 0, 1, 1]], dtype=np.float32)
    colour.data.foreach_set("color", values.ravel())
    triangle.data.uv_layers["UVMap"].uv[1].vector = np.nan, 0.25
    result = parts.generate(method=method)
    source = np.array([vertex.co for vertex in triangle.data.vertices])
    reflected = parts.attribute(result, "reflected_position")
    if method == "GENERAL":
        reflected = reflected[parts.corners(result)].reshape(-1, 3)
    weights = np.linalg.lstsq(np.vstack([source.T, np.ones(3)]), np.c_[reflected, np.ones(len(reflected))].T,
                              rcond=None)[0].T
    values[1] = 0.0, 0.0, 0.0, 1.0
    assert np.allclose(parts.attribute(result, "Tint"), weights @ values, atol=1e-5)
    assert np.allclose(parts.attribute(result, "UVMap"), weights @ [(0, 0), (0, 0.25), (0, 1)], atol=1e-5)


def test_all_settings_reach_the_core(wall_scene, room, tmp_path, monkeypatch):
    chosen = {"tolerance": 2.0, "placement": "VIRTUAL", "method": "PARALLEL", "depth": 3, "memory": 0.5,
              "hidden_faces": True}

    def told(context, participants, settings, *_, **__):
        raise room("core").ReflectionError(f"{settings(participants.mirrors[0])}.")
    for verb in ("generate", "compare"):
        monkeypatch.setattr(room(f"addon.operators.{verb}"), "generation", told)
    expected = str(room("core").Settings(2.0, "VIRTUAL", "PARALLEL", 3, maximum_memory=0.5, hidden_faces=True)) + "."
    assert parts.refusal(**chosen) == expected
    assert parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path), **chosen) == expected


def test_materials_carry_over_per_face(sphere_scene):
    result = parts.generate()
    names = [material.name for material in result.data.materials]
    assert sorted(names) == ["Red", "White"]
    sources = [item.object.name for item in result.reflection_mesh.sources]
    shown = np.array(names)[parts.attribute(result, "material_index")]
    owner = np.array(sources)[parts.attribute(result, "source_object")]
    assert (shown == np.where(owner == "Box", "Red", "White")).all()


def test_only_the_camera_sees_the_result(sphere_scene):
    result = parts.generate()
    assert result.visible_camera and not result.hide_render
    assert not any((result.visible_diffuse, result.visible_glossy, result.visible_transmission,
                    result.visible_volume_scatter, result.visible_shadow))


def test_selection_stays_and_the_result_is_active(sphere_scene):
    result = parts.generate()
    assert bpy.context.view_layer.objects.active == result
    assert set(bpy.context.selected_objects) == {*sphere_scene, result}


def test_generating_again_updates_in_place(wall_scene):
    mirror, triangle = wall_scene
    first = parts.generate()
    mesh, objects = first.data, len(bpy.data.objects)
    triangle.location.z += 0.25
    bpy.context.view_layer.update()
    parts.select(first)
    again = parts.generate(placement="SURFACE")
    assert again == first and again.data == mesh and len(bpy.data.objects) == objects
    heights = parts.attribute(again, "reflected_position")[:, 2]
    assert np.isclose(heights.max(), 1.95, atol=1e-6) and np.isclose(heights.min(), 0.85, atol=1e-6)
    assert len(again.data.uv_layers) == 1 and len(again.reflection_mesh.sources) == 1


def test_every_mirror_gets_a_result(wall_scene):
    mirror, triangle = wall_scene
    second = parts.add("plane", "Low", size=8.0)
    for obj in (mirror, second):
        obj.data.materials.append(parts.material(obj.name, "GLOSSY"))
    parts.select(mirror, second, triangle)
    parts.generate()
    results = [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"]
    assert {obj.name for obj in results} == {"Mirror Reflection", "Low Reflection"}
    assert all(obj.reflection_mesh.sources[0].object == triangle for obj in results)
    assert all(len(obj.data.polygons) for obj in results)


def test_result_lies_beside_its_mirror(wall_scene):
    mirror, _ = wall_scene
    shelf = bpy.data.collections.new("Shelf")
    bpy.context.scene.collection.children.link(shelf)
    shelf.objects.link(mirror)
    bpy.context.scene.collection.objects.unlink(mirror)
    assert [collection.name for collection in parts.generate().users_collection] == ["Shelf"]


def test_precision_holds_far_from_the_origin(wall_scene):
    """4096 units away a float32 world position is 5e-4 coarse; the virtual image's corners are right to 2e-6."""
    for obj in (*wall_scene, bpy.context.scene.camera):
        obj.location += type(obj.location)((4096.0, 4096.0, 0.0))
    bpy.context.view_layer.update()
    parts.select(*wall_scene[::-1])
    result = parts.generate(placement="VIRTUAL")
    assert np.allclose(result.location, (4096.0, 4097.0, 1.0), atol=0.0)
    vertices = parts.attribute(result, "position") + np.array(result.location, dtype=np.float64)
    vertices -= (4096.0, 4096.0, 0.0)
    source = np.array([vertex.co for vertex in wall_scene[1].data.vertices], dtype=np.float64)
    image = source * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)
    distance = np.linalg.norm(image[:, None] - vertices, axis=2).min(axis=1)
    assert distance.max() < 2e-6


def test_virtual_makes_a_window_of_the_mirror_until_cleared(wall_scene):
    mirror, _ = wall_scene
    parts.generate(placement="VIRTUAL")
    assert not mirror.visible_camera
    parts.generate(placement="LAYERED")
    assert mirror.visible_camera
    parts.generate(placement="VIRTUAL")
    bpy.ops.reflection_mesh.clear()
    assert mirror.visible_camera
    mirror.visible_camera = False
    parts.select(*wall_scene[::-1])
    parts.generate(placement="VIRTUAL")
    bpy.ops.reflection_mesh.clear()
    assert not mirror.visible_camera


def test_faces_of_other_materials_do_not_reflect(wall_scene):
    mirror, _ = wall_scene
    mirror.data.materials.append(parts.material("Glass", "PRINCIPLED"))
    mirror.data.materials.append(parts.material("Wood", "DIFFUSE"))
    parts.select(mirror)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    glass = np.array([polygon.center.x < 0.0 for polygon in mirror.data.polygons])
    mirror.data.polygons.foreach_set("material_index", np.where(glass, 0, 1).astype(np.int32))
    mirror.data.update()
    parts.select(*wall_scene)
    result = parts.generate()
    assert parts.attribute(result, "mirror_position")[:, 0].max() < 1e-6
    table = np.array([glass[triangle.polygon_index] for triangle in mirror.data.loop_triangles])
    faces = parts.attribute(result, "mirror_face")
    assert (faces >= 0).any() and table[faces[faces >= 0]].all()


def test_the_parallel_method_runs(sphere_scene):
    general = len(parts.generate(method="GENERAL").data.polygons)
    assert len(parts.generate(method="PARALLEL").data.polygons) not in {0, general}


def test_summary_tells_the_share_filled_by_rays_and_remarks_the_bounds_hit(sphere_scene, room):
    sphere, cube, floor = sphere_scene
    chosen = room("addon.reading.roles").Participants([sphere], [cube, floor], [])
    generate, settings = room("addon.operators.generate").generation, room("core").Settings

    def outcome(**options):
        return room("addon.command_line.verbs").announced(generate(bpy.context, chosen, settings(**options)))

    free, bounded = outcome(), outcome(tolerance=0.02, maximum_faces=2000)
    assert free.remarks == []
    assert "filled by rays" not in free.summary(1.0)
    filled = SimpleNamespace(estimated_error=0.4, filled_share=2.345)
    assert ", 2.3 % filled by rays, 1.00 s" in replace(free, results=[(free.results[0][0], filled)]).summary(1.0)
    assert len(bounded.remarks) == 1
    assert bounded.remarks[0].startswith("Ball: Refinement stopped at the largest number of faces")
    counts = json.loads(bounded.results[0][0].reflection_mesh.counts)
    assert counts["bounded"] == 1 and counts["limited"] > 0
    assert counts["joined"] + counts["cut"] == counts["polygons"]
