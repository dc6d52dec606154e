"""Instances as mirrors, and what instances, glass and objects of several materials let through."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import add_lamp, paint, rendered, scene_of


def instanced(obj: bpy.types.Object, kind: str) -> bpy.types.Object:
    """An instance of the object's collection in its place: by an empty, or by Geometry Nodes."""
    asset = bpy.data.collections.new("Asset")
    for collection in list(obj.users_collection):
        collection.objects.unlink(obj)
    asset.objects.link(obj)
    if kind == "EMPTY":
        made = bpy.data.objects.new("Instance", None)
        made.instance_type, made.instance_collection = "COLLECTION", asset
    else:
        made = bpy.data.objects.new("Instance", bpy.data.meshes.new("Instance"))
        tree = bpy.data.node_groups.new("Instance", "GeometryNodeTree")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        source = tree.nodes.new("GeometryNodeCollectionInfo")
        source.inputs["Collection"].default_value = asset
        tree.links.new(source.outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
        made.modifiers.new("Instance", "NODES").node_group = tree
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.update()
    return made


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["EMPTY", "NODES"])
def test_cycles_adds_nothing_to_the_light_of_an_instance(blank, tmp_path, kind):
    """Its light was there twice: Cycles' own went on."""
    floor, mirror, lamp = scene_of("AREA", size=0.6)
    made = instanced(mirror, kind)
    made.reflection_mesh.role = "MIRROR"
    parts.select(floor, lamp, made)
    own = rendered(tmp_path, 128).sum()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=4) == {"FINISHED"}
    light = bpy.data.objects["Instance Caustics"]
    together = rendered(tmp_path, 128).sum()
    light.hide_render = True
    rest = rendered(tmp_path, 128).sum()
    assert own > 1.1 * rest
    # some hundred of Cycles' rays find the lamp
    assert abs((together - rest) / (own - rest) - 1.0) < 0.1
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert lamp.light_linking.receiver_collection is None


def irradiance() -> np.ndarray:
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    return parts.attribute(bpy.data.objects["Mirror Caustics"], "irradiance")


@pytest.mark.parametrize("kind", ["EMPTY", "NODES"])
def test_instances_stand_in_the_way(blank, kind):
    """As the object itself does."""
    floor, mirror, lamp = scene_of()
    free = irradiance()
    wall = parts.add("cube", "Wall", size=0.2, location=(0.6, 0.0, 0.4))
    parts.select(floor, lamp, mirror)
    shaded = irradiance()
    assert len(shaded) != len(free)
    instanced(wall, kind)
    parts.select(floor, lamp, mirror)
    assert np.array_equal(irradiance(), shaded)


def test_a_frame_stands_in_the_way_and_its_pane_does_not(blank):
    """As the frame alone does."""
    floor, mirror, lamp = scene_of()
    frame = parts.add("grid", "Window", size=0.6, x_subdivisions=3, y_subdivisions=3, location=(0.5, 0.0, 0.4))
    frame.data.materials.append(paint("Wood", "DIFFUSE", (0.3, 0.2, 0.1)))
    pane = paint("Pane", "PRINCIPLED", (1.0, 1.0, 1.0), "Base Color")
    pane.node_tree.nodes[0].inputs["Transmission Weight"].default_value = 1.0
    frame.data.materials.append(pane)
    parts.select(floor, lamp, mirror)
    closed = flux()
    middle = next(face.index for face in frame.data.polygons if face.center.length < 0.05)
    frame.data.polygons[middle].material_index = 1
    with_pane = flux()
    corners = [tuple(face.vertices) for face in frame.data.polygons if face.index != middle]
    places = [tuple(vertex.co) for vertex in frame.data.vertices]
    frame.data.clear_geometry()
    frame.data.from_pydata(places, [], corners)
    open_middle = flux()
    frame.hide_render = True
    assert closed < 0.995 * open_middle and open_middle < 0.95 * flux()
    assert abs(with_pane / open_middle - 1.0) < 1e-4


CLEAR = {"transparent": ("ShaderNodeBsdfTransparent", {}), "glass": ("ShaderNodeBsdfGlass", {}),
         "pane": ("ShaderNodeBsdfPrincipled", {"Transmission Weight": 1.0}),
         "open": ("ShaderNodeBsdfPrincipled", {"Alpha": 0.0})}


@pytest.mark.thorough
@pytest.mark.parametrize("grouped", [False, True])
@pytest.mark.parametrize("kind", CLEAR)
def test_clear_panes_are_not_lit_and_shade_nothing(blank, room, capfd, kind, grouped):
    """Where all that is there is lit, a window among it: as if it were not there. It took all the light."""
    floor, mirror, lamp = scene_of()
    parts.select(lamp, mirror)
    free = flux()
    window = parts.add("plane", "Window", size=0.6, location=(0.5, 0.0, 0.4))
    material = paint("Pane", "DIFFUSE", (1.0, 1.0, 1.0))
    tree = bpy.data.node_groups.new("Pane", "ShaderNodeTree") if grouped else material.node_tree
    shader = tree.nodes.new(CLEAR[kind][0])
    for socket, value in CLEAR[kind][1].items():
        shader.inputs[socket].default_value = value
    both = tree.nodes.new("ShaderNodeMixShader")
    for socket in both.inputs[1:]:
        tree.links.new(shader.outputs[0], socket)
    surface = both.outputs[0]
    if grouped:
        tree.interface.new_socket("Pane", in_out="OUTPUT", socket_type="NodeSocketShader")
        tree.links.new(surface, tree.nodes.new("NodeGroupOutput").inputs[0])
        group = material.node_tree.nodes.new("ShaderNodeGroup")
        group.node_tree = tree
        surface = group.outputs[0]
    output = material.node_tree.get_output_node("ALL")
    window.data.materials.append(material)
    parts.select(lamp, mirror)
    # still of plaster
    assert flux() == pytest.approx(free, rel=1e-6) and _on("Window") > 0.02 * free
    material.node_tree.links.new(surface, output.inputs["Surface"])
    parts.select(lamp, mirror)
    assert flux() == pytest.approx(free, rel=1e-6) and _on("Window") == 0.0
    floor.data.materials[0] = material
    parts.select(lamp, mirror)
    assert parts.refusal(bpy.ops.reflection_mesh.caustics) == room("addon.illumination.sheets").ALL_CLEAR


def _on(name: str) -> float:
    """W of the light that fall on an object."""
    sources = [one.object.name for one in bpy.data.objects["Mirror Caustics"].reflection_mesh.sources]
    return float(_watts()[parts.attribute(bpy.data.objects["Mirror Caustics"], "source_object")
                          == sources.index(name)].sum())


def flux() -> float:
    """W of the light, made now."""
    for obj in bpy.data.objects:
        if obj.type == "MESH":
            obj.data.update()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    return float(_watts().sum())


def _watts() -> np.ndarray:
    """Of the faces of light."""
    light = bpy.data.objects["Mirror Caustics"]
    each, mesh = parts.attribute(light, "irradiance").astype(np.float64).reshape(-1, 3).mean(axis=1), light.data
    area = np.empty(len(mesh.polygons), dtype=np.float32)
    mesh.polygons.foreach_get("area", area)
    return each * area


def test_lamps_in_instances_are_told(blank, capfd):
    """Of these no light is thrown, and nothing said so."""
    floor, mirror, lamp = scene_of()
    rig, other = bpy.data.collections.new("Rig"), add_lamp("Other", "POINT", (-0.9, -0.3, 1.5))
    bpy.context.scene.collection.objects.unlink(other)
    rig.objects.link(other)
    instance = bpy.data.objects.new("Rig Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", rig
    bpy.context.scene.collection.objects.link(instance)
    for chosen, told in (((floor, lamp, mirror), False), ((floor, lamp, instance, mirror), True),
                         ((floor, mirror), True)):
        parts.select(*chosen)
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert ("lamps that 'Rig Instance' instances" in capfd.readouterr().out) is told
    other.hide_render = True
    blank.view_layer.update()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "Rig Instance" not in capfd.readouterr().out
