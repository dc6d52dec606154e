"""The method Points in Blender: loose points with discs, against closed forms of the flat mirror and Cycles."""
import json

import bpy
import numpy as np
import parts
import pytest
from mathutils.kdtree import KDTree

EYE = np.array([0.0, -6.0, 1.0])
MIRRORED = np.array([1.0, -1.0, 1.0]), np.array([0.0, 2.0, 0.0])
ATTRIBUTES = {"reflected_position": "FLOAT_VECTOR", "mirror_position": "FLOAT_VECTOR", "path_length": "FLOAT",
              "image_parity": "INT", "radius": "FLOAT", "source_object": "INT", "source_face": "INT",
              "mirror_face": "INT"}


@pytest.fixture
def scan_scene(blank):
    """A wall mirror at y = 1 and a dense ball before it: its lower half red, its upper half in its vertices' colour."""
    mirror = parts.add_wall_mirror()
    ball = parts.add("ico_sphere", "Scan", subdivisions=6, radius=0.7, location=(0.2, -1.0, 1.0))
    ball.data.materials.append(parts.material("Red"))
    ball.data.materials.append(parts.material("Tinted"))
    ball.data.materials[0].node_tree.nodes["Emission"].inputs[0].default_value = (1.0, 0.0, 0.0, 1.0)
    tree = ball.data.materials[1].node_tree
    colour = tree.nodes.new("ShaderNodeVertexColor")
    colour.layer_name = "Tint"
    tree.links.new(colour.outputs[0], tree.nodes["Emission"].inputs[0])
    upper = [polygon.center.z > 0.0 for polygon in ball.data.polygons]
    ball.data.polygons.foreach_set("material_index", np.array(upper, dtype=np.int32))
    places = np.array([vertex.co for vertex in ball.data.vertices])
    tint = np.column_stack((0.5 + 0.5 * places, np.ones(len(places)))).astype(np.float32)
    ball.data.color_attributes.new("Tint", "FLOAT_COLOR", "POINT").data.foreach_set("color", tint.ravel())
    ball.data.update()
    parts.select(ball, mirror)
    return mirror, ball


def drawn(result) -> bpy.types.Mesh:
    return result.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def test_every_vertex_is_a_point_on_the_ray_to_its_mirrored_place(scan_scene):
    mirror, ball = scan_scene
    result = parts.generate(method="POINTS")
    assert result.name == "Mirror Reflection" and result.reflection_mesh.role == "REFLECTION"
    assert result.reflection_mesh.mirror == mirror and result.reflection_mesh.sources[0].object == ball
    counts = json.loads(result.reflection_mesh.counts)
    assert result.reflection_mesh.points == len(result.data.vertices) == counts["images"]
    # a few lie so close together that one stands for two
    assert counts["images"] + counts["stood_for"] == len(ball.data.vertices) and counts["stood_for"] < 10
    assert len(result.data.polygons) == 0 and result.reflection_mesh.faces == 0
    found = {name: result.data.attributes[name].data_type for name in ATTRIBUTES}
    assert found == ATTRIBUTES
    assert {result.data.attributes[name].domain for name in ATTRIBUTES} == {"POINT"}
    position = parts.attribute(result, "position") + np.array(result.location)
    reflected = parts.attribute(result, "reflected_position")
    image = reflected * MIRRORED[0] + MIRRORED[1]
    towards = (image - EYE) / np.linalg.norm(image - EYE, axis=1, keepdims=True)
    assert np.linalg.norm(np.cross(position - EYE, towards), axis=1).max() < 3e-6
    assert (position[:, 1] < 1.0).all()
    tree = KDTree(len(ball.data.vertices))
    for vertex in ball.data.vertices:
        tree.insert(vertex.co + ball.location, vertex.index)
    tree.balance()
    nearest = [tree.find(place) for place in reflected]
    assert max(away for _, _, away in nearest) < 1e-6 and len({index for _, index, _ in nearest}) == len(reflected)
    length = np.linalg.norm(reflected - parts.attribute(result, "mirror_position"), axis=1)
    assert np.allclose(parts.attribute(result, "path_length"), length, atol=1e-5)


def test_discs_lie_round_their_points_and_face_the_eye(scan_scene):
    result = parts.generate(method="POINTS")
    mesh, count = drawn(result), len(result.data.vertices)
    assert len(mesh.polygons) == count
    normals, centres = (np.array([getattr(polygon, name)[:] for polygon in mesh.polygons])
                        for name in ("normal", "center"))
    points, radius = parts.attribute(result, "position"), parts.attribute(result, "radius")
    assert np.abs(centres - points).max() < 1e-6
    towards = EYE - np.array(result.location) - centres
    assert ((normals * towards).sum(axis=1) > 0.0).all()
    # flat on the mirror, so that no disc sinks into it
    assert np.abs(np.abs(normals[:, 1]) - 1.0).max() < 1e-3
    corners = np.array([vertex.co[:] for vertex in mesh.vertices])
    corners = corners[np.array([polygon.vertices[:] for polygon in mesh.polygons])] - centres[:, None]
    reach = np.linalg.norm(corners, axis=2).max(axis=1)
    # the hexagon round the disc; a mirror seen aslant draws it out a little
    assert (reach > 0.99 * radius).all() and (reach < 1.5 * radius).all()


def test_discs_carry_what_faces_carry(scan_scene):
    _, ball = scan_scene
    result = parts.generate(method="POINTS")
    mesh = drawn(result)
    names = [material.name for material in mesh.materials if material]
    assert names == ["Red", "Tinted"]
    index = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", index)
    height = parts.attribute(result, "reflected_position")[:, 2] - 1.0
    assert (index[height > 0.02] == 1).all() and (index[height < -0.02] == 0).all()
    faces = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.attributes["source_face"].data.foreach_get("value", faces)
    points = parts.attribute(result, "reflected_position")
    for number, point in list(zip(faces, points, strict=True))[::500]:
        corners = [ball.data.vertices[vertex].co + ball.location for vertex in ball.data.polygons[number].vertices]
        assert min(np.linalg.norm(np.array(corner) - point) for corner in corners) < 1e-5
    assert mesh.attributes["UVMap"].domain == "CORNER" and mesh.uv_layers[0].name == "UVMap"
    tint = parts.attribute(result, "Tint")
    assert np.allclose(tint[:, :3], 0.5 + 0.5 * (points - np.array(ball.location)), atol=1e-5)
    assert mesh.color_attributes.render_color_index == 0


@pytest.mark.thorough
def test_a_render_shows_the_same_as_the_mesh(scan_scene, tmp_path):
    mirror, ball = scan_scene
    pictures = []
    for method in ("POINTS", "GENERAL"):
        parts.select(ball, mirror)
        parts.generate(method=method)
        ball.hide_render = True
        pictures.append(_render(tmp_path / f"{method}.exr"))
        ball.hide_render = False
    points, mesh = pictures
    seen = mesh[..., 3] > 0.5
    assert seen.sum() > 1000
    assert (points[..., 3] > 0.5)[seen].mean() > 0.998
    # one pixel round the ball, whose outline is about 160 pixels long
    assert (points[..., 3] > 0.5)[~seen].sum() < 200
    # inside the outline, and off the line where red meets tint, which is as fine as the vertices are
    inside = np.all([np.roll(seen, shift, axis=axis) for shift in (-2, 2) for axis in (0, 1)], axis=0)
    apart = np.abs(points - mesh)[inside][:, :3].max(axis=1)
    assert np.median(apart) < 0.02 and (apart > 0.1).mean() < 0.06
    assert (points[inside][:, 2] < 0.1).any() and (points[inside][:, 2] > 0.4).any()


def _render(path) -> np.ndarray:
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.render.film_transparent = "CYCLES", 1, True
    scene.render.image_settings.file_format = "OPEN_EXR"
    mirror = bpy.data.objects["Mirror"]
    mirror.hide_render = True
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    mirror.hide_render = False
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], 4)


def test_methods_replace_each_other_in_place(scan_scene):
    mirror, ball = scan_scene
    first = parts.generate(method="POINTS")
    data, groups = first.data, len(bpy.data.node_groups)
    assert groups == len(first.modifiers) == 1
    ball.location.z += 0.3
    bpy.context.view_layer.update()
    again = parts.generate(method="POINTS", placement="SURFACE")
    assert again == first and again.data == data and len(bpy.data.node_groups) == len(again.modifiers) == 1
    assert np.isclose(parts.attribute(again, "reflected_position")[:, 2].max(), 2.0, atol=1e-4)
    mesh = parts.generate(method="GENERAL")
    assert mesh == first and len(mesh.modifiers) == 0 and len(bpy.data.node_groups) == 0
    assert len(mesh.data.polygons) > 1000 and mesh.reflection_mesh.points == 0
    assert "radius" not in mesh.data.attributes and not mesh.data.validate(verbose=True)
    points = parts.generate(method="POINTS")
    assert points == first and len(points.modifiers) == 1 and len(points.data.polygons) == 0
    assert len(bpy.data.objects) == 4


def test_clear_takes_the_nodes_along(scan_scene):
    mirror, _ = scan_scene
    parts.generate(method="POINTS", placement="VIRTUAL")
    assert not mirror.visible_camera
    bpy.ops.reflection_mesh.clear()
    assert mirror.visible_camera
    assert not bpy.data.node_groups and not [mesh for mesh in bpy.data.meshes if "Reflection" in mesh.name]


def test_nodes_that_the_user_shares_stay(scan_scene):
    result = parts.generate(method="POINTS")
    other = result.copy()
    bpy.context.scene.collection.objects.link(other)
    other.reflection_mesh.role = "IGNORE"
    bpy.ops.reflection_mesh.clear()
    assert other.modifiers[0].node_group is not None and len(bpy.data.node_groups) == 1


def test_points_survive_saving_and_loading(scan_scene, tmp_path):
    count = len(drawn(parts.generate(method="POINTS")).polygons)
    path = str(tmp_path / "points.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    result = bpy.data.objects["Mirror Reflection"]
    assert len(drawn(result).polygons) == count > 1000
    assert result.reflection_mesh.points == len(result.data.vertices)
    parts.select(result)
    assert parts.generate(method="POINTS") == result and len(bpy.data.node_groups) == 1


@pytest.mark.feature("points")
def test_compare_judges_points_as_it_judges_meshes(scan_scene, tmp_path):
    # aside, so that the ball does not stand before its own reflection
    scan_scene[1].location = (2.0, -1.2, 1.0)
    bpy.context.view_layer.update()
    parts.generate(method="POINTS")
    assert bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", filepath=str(tmp_path), samples=1) == {"FINISHED"}
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["displacement_px"]["median"] < 1.0
    assert report["coverage_percent"]["hole"] < 0.05 and report["coverage_percent"]["spill"] < 1.0


def test_coarse_objects_are_told(blank, room):
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    parts.select(leaf, parts.add_wall_mirror())
    generate, choose = room("addon.operators.generate").generation, room("addon.reading.roles").choose
    steps = generate(bpy.context, choose(bpy.context), room("core").Settings(method="POINTS"))
    outcome = room("addon.faults").finished(steps)
    assert len(outcome.remarks) == 1 and outcome.remarks[0].startswith("Mirror: 100.0 % of the points")
