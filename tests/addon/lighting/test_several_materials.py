"""Mirrors of several materials: each of their faces reflects as its own does."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, picture, principled, psnr, scene_of, shader_of

TINTS = ((0.9, 0.5, 0.2), (0.3, 0.6, 0.9))


def _checked() -> bpy.types.Material:
    made = principled("Checks", Metallic=1.0, Roughness=0.0)
    checks = made.node_tree.nodes.new("ShaderNodeTexChecker")
    checks.inputs["Scale"].default_value = 12.0
    checks.inputs["Color1"].default_value, checks.inputs["Color2"].default_value = (1, .9, .5, 1), (.2, .4, .9, 1)
    coordinates = made.node_tree.nodes.new("ShaderNodeTexCoord")
    link(made.node_tree, coordinates.outputs["UV"], checks.inputs["Vector"])
    link(made.node_tree, checks.outputs["Color"], shader_of(made).inputs["Base Color"])
    return made


def _ball(kind: str) -> bpy.types.Object:
    """A smooth ball in the place of the wall mirror, in bands of materials that go across its faces' rows."""
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    ball = parts.add("uv_sphere", "Mirror", radius=1.5, location=(0.0, 1.0, 0.9), segments=24, ring_count=12,
                     rotation=(0.5, 0.2, 0.4))
    ball.data.shade_smooth()
    if kind == "metals":
        made = [principled("Gold", TINTS[0], Metallic=1.0, Roughness=0.0), _checked(),
                principled("Plain", (1.0, 1.0, 1.0), Metallic=1.0, Roughness=0.0)]
    else:
        made = [principled("Varnish", (0.5, 0.1, 0.1), Roughness=0.9, **{"Coat Weight": 1.0, "Coat Roughness": 0.0}),
                principled("Glass", (1.0, 1.0, 1.0), Roughness=0.0, **{"Transmission Weight": 1.0})]
    made.append(principled("No face has it", (0.0, 1.0, 0.0), Metallic=1.0, Roughness=0.0))
    for material in made:
        ball.data.materials.append(material)
    for number, polygon in enumerate(ball.data.polygons):
        polygon.material_index = number // 3 % (len(made) - 1)
    ball.reflection_mesh.role = "MIRROR"
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], ball)
    return ball


@pytest.mark.parametrize(("kind", "faces"), [
    ("metals", "whole"), *(pytest.param(kind, "cut", marks=pytest.mark.slow)
                           for kind in ("metals", "varnish and glass"))])
def test_light_on_objects_is_reflected_by_each(blank, room, monkeypatch, kind, faces):
    scene_of(blank)
    _ball(kind)
    if faces == "whole":
        monkeypatch.setattr(room("core.whole_faces.whole"), "LEAST_TRIANGLES", 1000)
        fine = bpy.data.objects["Floor"].modifiers.new("Fine", "SUBSURF")
        fine.subdivision_type, fine.levels, fine.render_levels = "SIMPLE", 5, 5
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    # what glass lets through is not denoised (measured: 0.1 dB farther than another render; metals 3 dB nearer)
    assert psnr(picture(room), reference) > psnr(other, reference) + (1.5 if kind == "metals" else -0.5)


def test_previews_have_the_tint_of_each(blank, room):
    wall = scene_of(blank, "", "Tint")
    card = parts.add("plane", "Card", size=3.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(principled("Card", (0.5, 0.5, 0.5)))
    mesh = bpy.data.meshes.new("Two")
    size = [abs(value) for value in wall.data.vertices[0].co]
    wide, high = sorted(size)[1:]
    mesh.from_pydata([(x * wide, y * high, 0.0) for x in (-1, 0, 1) for y in (-1, 1)], [],
                     [(0, 2, 3, 1), (2, 4, 5, 3)])
    mesh.polygons[1].material_index = 1
    for tint in TINTS:
        mesh.materials.append(principled("Metal", tint, Metallic=1.0, Roughness=0.0))
    wall.data = mesh
    parts.select(card, wall)
    parts.generate(preview=True)
    shown = picture(room)
    middle = np.array(shown.shape[:2]) // 2
    for side, columns in enumerate((slice(middle[1] - 12, middle[1] - 4), slice(middle[1] + 4, middle[1] + 12))):
        linear = 0.5 * np.array(TINTS[side])
        expected = 1.055 * linear ** (1 / 2.4) - 0.055
        assert np.abs(shown[60:68, columns].mean(axis=(0, 1)) - expected).max() < 0.02, side


def test_no_face_lies_on_two_of_them(blank):
    """A hill of two halves before a dense sheet, which is drawn by its vertices, and one of two triangles."""
    columns = np.linspace(-1.0, 1.0, 11)
    x, y = (values.ravel() for values in np.meshgrid(columns, columns))
    mesh = bpy.data.meshes.new("Hill")
    first = (11 * np.arange(10)[:, None] + np.arange(10)).ravel()
    mesh.from_pydata(np.column_stack((x, y, -0.1 * (x * x + y * y))).tolist(), [],
                     np.column_stack((first, first + 1, first + 12, first + 11)).tolist())
    hill = bpy.data.objects.new("Hill", mesh)
    blank.scene.collection.objects.link(hill)
    for tint in TINTS:
        mesh.materials.append(principled("Metal", tint, Metallic=1.0, Roughness=0.0))
    for polygon in mesh.polygons:
        polygon.use_smooth, polygon.material_index = True, int(polygon.center.x > 0.0)
    sheets = [parts.add("plane", "Large", size=6.0, location=(0.0, 2.0, 3.0), rotation=(0.9, 0.1, 0.0)),
              parts.add("grid", "Dense", size=1.0, location=(0.5, 1.0, 1.0), x_subdivisions=80, y_subdivisions=80)]
    blank.scene.camera.location, blank.scene.camera.rotation_euler = (0.0, -4.0, 2.5), (1.02, 0.0, 0.0)
    parts.select(*sheets, hill)
    shown = parts.generate().data
    across = np.empty((len(shown.vertices), 3), dtype=np.float32)
    shown.attributes["mirror_position"].data.foreach_get("vector", across.ravel())
    corner = np.empty(len(shown.loops), dtype=np.int32)
    shown.attributes[".corner_vert"].data.foreach_get("value", corner)
    span = np.empty(len(shown.polygons), dtype=np.int32)
    shown.attributes["mirror_face"].data.foreach_get("value", span)
    place = across[corner.reshape(-1, 3), 0]
    over_both = np.minimum(place.max(axis=1), -place.min(axis=1))
    assert (span < 0).mean() > 0.05
    assert over_both.max() < 1e-4


@pytest.mark.parametrize("kind", ["vertices", pytest.param("nodes", marks=pytest.mark.slow)])
def test_instances_of_a_mirror_reflect_as_what_is_instanced(blank, room, kind):
    """The mirror, which instances it, has no material of its own."""
    wall = scene_of(blank, "", "Tint")
    carrier = bpy.data.objects.new("Carrier", bpy.data.meshes.new("Carrier"))
    carrier.data.from_pydata([(0.0, 0.0, 0.0)], [], [])
    carrier.matrix_world = wall.matrix_world
    blank.scene.collection.objects.link(carrier)
    if kind == "vertices":
        wall.matrix_world = np.eye(4)
        wall.parent, carrier.instance_type = carrier, "VERTS"
    else:
        wall.hide_render = wall.hide_viewport = True
        _instance_by_nodes(carrier, wall)
    carrier.reflection_mesh.role = "MIRROR"
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], carrier)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference)


def _instance_by_nodes(carrier: bpy.types.Object, instanced: bpy.types.Object) -> None:
    tree = bpy.data.node_groups.new("Instances", "GeometryNodeTree")
    for side in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=side, socket_type="NodeSocketGeometry")
    given, made, points, info = (tree.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo"))
    info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = instanced, True
    for output, socket in ((given.outputs[0], points.inputs["Points"]),
                           (info.outputs["Geometry"], points.inputs["Instance"]),
                           (points.outputs[0], made.inputs[0])):
        tree.links.new(output, socket)
    carrier.modifiers.new("Instances", "NODES").node_group = tree
