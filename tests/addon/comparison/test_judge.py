"""Mirrors and sources in the ground truth: instances, materials by face, and transparent objects.

Every picture here is right, so Compare must find next to nothing wrong; what blocks the view must not be judged.
"""
from __future__ import annotations

import json

import bpy
import numpy as np
import parts
import pytest

WRONG = 0.1  # per cent of the mirror's pixels
SIZE = 128, 96


@pytest.fixture
def stage(blank):
    """A camera in front of a wall mirror, and a box before it that is reflected; the mirror."""
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = SIZE
    box = parts.add("cube", "Box", size=0.8, location=(-0.9, -1.0, 0.7))
    box.data.materials.append(parts.material("Paint"))
    floor = parts.add("plane", "Floor", size=12.0, location=(0.0, -1.0, -1.2))
    floor.data.materials.append(parts.material("Ground"))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Silver", "GLOSSY"))
    return mirror


def compared(tmp_path, *selected) -> dict:
    """The report on the selected mirrors, whose reflections are generated."""
    parts.select(*selected)
    parts.generate()
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1) == {"FINISHED"}
    return json.loads((tmp_path / "report.json").read_text())


def is_right(report: dict) -> None:
    assert report["coverage_percent"]["all"] < WRONG
    assert report["displacement_px"]["p99"] < 0.5


def tiles(material: bpy.types.Material) -> bpy.types.Object:
    """A ball whose faces are squares that Geometry Nodes make and instance: none has an object of its own."""
    ball = parts.add("ico_sphere", "Tiles", subdivisions=2, radius=1.0, location=(0.4, -0.6, 1.2))
    group = bpy.data.node_groups.new("Tiles", "GeometryNodeTree")
    for place in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=place, socket_type="NodeSocketGeometry")
    node = {kind: group.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeInstanceOnPoints", "GeometryNodeMeshGrid",
        "GeometryNodeSetMaterial", "GeometryNodeInputNormal", "FunctionNodeAlignRotationToVector")}
    start, end, instances, grid, paint, normal, turn = node.values()
    turn.axis = "Z"
    for name, value in (("Size X", 0.3), ("Size Y", 0.3), ("Vertices X", 2), ("Vertices Y", 2)):
        grid.inputs[name].default_value = value
    paint.inputs["Material"].default_value = material
    for source, socket in ((start.outputs[0], instances.inputs["Points"]), (grid.outputs[0], paint.inputs["Geometry"]),
                           (paint.outputs[0], instances.inputs["Instance"]), (normal.outputs[0], turn.inputs["Vector"]),
                           (turn.outputs[0], instances.inputs["Rotation"]), (instances.outputs[0], end.inputs[0])):
        group.links.new(source, socket)
    ball.modifiers.new("Tiles", "NODES").node_group = group
    return ball


def instanced(*objects: bpy.types.Object) -> bpy.types.Object:
    """Objects as an instance of their collection, which is in no scene itself."""
    collection = bpy.data.collections.new("Assembly")
    for obj in objects:
        for other in list(obj.users_collection):
            other.objects.unlink(obj)
        collection.objects.link(obj)
    instancer = bpy.data.objects.new("Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", collection
    bpy.context.scene.collection.objects.link(instancer)
    bpy.context.view_layer.update()
    return instancer


def opened(name: str, factor: str, inside: str = "") -> bpy.types.Material:
    """Paint that is open by a `factor`: the side that is seen, a texture, or a number; `inside` of a group or a sum."""
    material = parts.material(name)
    tree = material.node_tree
    paint, output = tree.nodes["Emission"], tree.nodes["Material Output"]
    if inside == "GROUP":
        group = bpy.data.node_groups.new("Opened", "ShaderNodeTree")
        group.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
        whole, use = tree, tree.nodes.new("ShaderNodeGroup")
        use.node_tree = tree = group
        whole.links.new(use.outputs[0], output.inputs["Surface"])
        paint, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("NodeGroupOutput")
    mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    if factor == "SIDE":
        tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
    elif factor == "TEXTURE":
        tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Fac"], mix.inputs[0])
    else:
        mix.inputs[0].default_value = float(factor)
    tree.links.new(paint.outputs[0], mix.inputs[1])
    tree.links.new(clear.outputs[0], mix.inputs[2])
    surface = mix.outputs[0]
    if inside == "SUM":
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(surface, both.inputs[0])
        tree.links.new(tree.nodes.new("ShaderNodeEmission").outputs[0], both.inputs[1])
        surface = both.outputs[0]
    tree.links.new(surface, output.inputs[0])
    return material


def glass(name: str = "Glass") -> bpy.types.Material:
    material = parts.material(name)
    tree = material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeBsdfGlass").outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    tree.nodes["Glass BSDF"].inputs["Roughness"].default_value = 0.0
    return material


@pytest.mark.skipif(not hasattr(bpy.types, "FunctionNodeAlignRotationToVector"), reason="Blender has no such node")
def test_instances_of_raw_geometry_are_seen_in_the_mirror(stage, tmp_path):
    tiles(parts.material("Orange"))
    report = compared(tmp_path, stage)
    is_right(report)
    assert report["measured_pixels"] > 1500


@pytest.mark.skipif(not hasattr(bpy.types, "FunctionNodeAlignRotationToVector"), reason="Blender has no such node")
def test_instances_of_raw_geometry_are_mirrors(stage, tmp_path):
    bpy.data.objects.remove(stage)
    ball = tiles(parts.material("Silver", "GLOSSY"))
    ball.reflection_mesh.role = "MIRROR"
    report = compared(tmp_path, ball)
    is_right(report)
    assert report["judged_pixels"] > 500


def test_the_frame_in_a_collection_instance_does_not_reflect(stage, tmp_path):
    alone = compared(tmp_path / "alone", stage)
    for result in [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"]:
        bpy.data.objects.remove(result)
    frame = parts.add("cube", "Frame", size=1.0, location=(0.0, 1.2, 1.0))
    frame.scale = (4.6, 0.3, 4.6)
    frame.data.materials.append(parts.material("Wood"))
    whole = instanced(stage, frame)
    whole.reflection_mesh.role = "MIRROR"
    report = compared(tmp_path / "instance", whole)
    is_right(report)
    assert report["mirror_pixels"] == alone["mirror_pixels"]


def test_what_is_ignored_in_a_collection_instance_is_not_reflected(stage, tmp_path):
    ignored = parts.add("cube", "Ignored", size=1.0, location=(0.8, -1.0, 0.6))
    ignored.data.materials.append(parts.material("Red"))
    ignored.reflection_mesh.role = "IGNORE"
    instanced(bpy.data.objects["Box"], ignored)
    is_right(compared(tmp_path, stage))


@pytest.mark.thorough
@pytest.mark.parametrize(("factor", "inside"), [("SIDE", ""), ("SIDE", "GROUP"), ("SIDE", "SUM"), ("0.9", "")])
def test_a_mirror_behind_what_is_open_to_the_camera_is_judged(stage, tmp_path, factor, inside):
    """The wall's front, which the mirror sees, is reflected; of a film that is open for most light nothing is."""
    wall = parts.add("plane", "Wall", size=2.0, location=(0.0, -3.5, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    wall.data.materials.append(opened("One-sided", factor, inside))
    report = compared(tmp_path, stage)
    is_right(report)
    wall.hide_render = True
    assert report["mirror_pixels"] == compared(tmp_path, stage)["mirror_pixels"] > 3000


def test_a_mirror_behind_an_opaque_wall_is_not_judged(stage, tmp_path):
    """There are no mirror pixels, of which anything could be a percentage."""
    wall = parts.add("plane", "Wall", size=9.0, location=(0.0, -3.5, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    wall.data.materials.append(parts.material("Paint"))
    report = compared(tmp_path, stage)
    assert report["mirror_pixels"] == report["judged_pixels"] == 0
    assert set(report["coverage_percent"].values()) == {None}
    assert "no mirror pixels" in (tmp_path / "report.html").read_text()


def test_textured_openings_before_the_camera_are_looked_through(stage, tmp_path):
    """Check this for direct view alone: on the reflection mesh a texture may have other coordinates."""
    leaf = parts.add("plane", "Leaf", size=2.0, location=(0.0, -1.5, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    leaf.data.materials.append(opened("Leaf", "TEXTURE"))
    report = compared(tmp_path, stage)
    is_right(report)
    whole = SIZE[0] * SIZE[1]
    leaf.data.materials[0] = parts.material("Closed")
    closed = compared(tmp_path, stage)["mirror_pixels"]
    leaf.hide_render = True
    without = compared(tmp_path, stage)["mirror_pixels"]
    # about half of the checks are open
    assert 0.3 < (report["mirror_pixels"] - closed) / (without - closed) < 0.7
    assert without - closed > 0.05 * whole


@pytest.mark.parametrize("thickness", [0.01, 0.2])
def test_silver_on_the_back_of_a_glass_slab_is_judged(stage, tmp_path, thickness):
    bpy.data.objects.remove(stage)
    slab = parts.add("cube", "Slab", size=1.0, location=(0.0, 1.0, 1.0))
    slab.scale = (4.0, thickness, 4.0)
    for material in (glass(), parts.material("Silver", "GLOSSY")):
        slab.data.materials.append(material)
    for polygon in slab.data.polygons:
        polygon.material_index = int(polygon.normal.y > 0.5)
    report = compared(tmp_path, slab)
    is_right(report)
    assert report["measured_pixels"] > 2000


def test_a_mirror_behind_a_pane_is_judged(stage, tmp_path):
    alone = compared(tmp_path, stage)
    pane = parts.add("cube", "Pane", size=1.0, location=(0.0, -2.5, 1.0))
    pane.scale = (1.5, 0.02, 1.5)
    pane.data.materials.append(glass())
    report = compared(tmp_path, stage)
    is_right(report)
    assert report["mirror_pixels"] == alone["mirror_pixels"]


def test_a_mirror_that_is_open_from_behind_is_none_there(stage, tmp_path):
    """Though it is one by its role, and its other side is judged."""
    tree = stage.data.materials[0].node_tree
    mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
    silver, output = tree.nodes["Glossy BSDF"], tree.nodes["Material Output"]
    for source, socket in ((silver.outputs[0], mix.inputs[1]), (clear.outputs[0], mix.inputs[2]),
                           (mix.outputs[0], output.inputs["Surface"])):
        tree.links.new(source, socket)
    stage.reflection_mesh.role = "MIRROR"
    is_right(compared(tmp_path, stage))
    stage.data.flip_normals()
    assert compared(tmp_path, stage)["mirror_pixels"] == 0
