"""Instances of what is hidden in renders by itself: read where Cycles shows them, and nowhere else."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest


def _by_nodes(node: str, chosen, points: bool, by_modifier: bool, **values) -> bpy.types.Object:
    """An object whose modifier makes instances of what a node gives, itself or on `points`; what is chosen the node
    names, or the modifier."""
    tree = bpy.data.node_groups.new("Instances", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    info, end = tree.nodes.new(node), tree.nodes.new("NodeGroupOutput")
    for name, value in values.items():
        info.inputs[name].default_value = value
    made, kind = next(socket for socket in info.outputs if socket.type == "GEOMETRY"), chosen.bl_rna.identifier
    if points:
        point, placed = tree.nodes.new("GeometryNodePoints"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        tree.links.new(point.outputs[0], placed.inputs["Points"])
        tree.links.new(made, placed.inputs["Instance"])
        made = placed.outputs[0]
    tree.links.new(made, end.inputs[0])
    holder = bpy.data.objects.new("Holder", bpy.data.meshes.new("Holder"))
    modifier = holder.modifiers.new("Instances", "NODES")
    modifier.node_group = tree
    if by_modifier:
        socket = tree.interface.new_socket(kind, in_out="INPUT", socket_type=f"NodeSocket{kind}")
        tree.links.new(tree.nodes.new("NodeGroupInput").outputs[0], info.inputs[kind])
        if bpy.app.version < (5, 2, 0):
            modifier[socket.identifier] = chosen
        else:
            getattr(modifier.properties.inputs, socket.identifier).value = chosen
    else:
        info.inputs[kind].default_value = chosen
    return holder


def _holder(kind: str, cube: bpy.types.Object) -> bpy.types.Object:
    """What instances a cube."""
    scene, collection = bpy.context.scene, bpy.data.collections.new("Cubes")
    points, by_modifier = "points" in kind, "modifier" in kind
    if kind.startswith("object"):
        holder = _by_nodes("GeometryNodeObjectInfo", cube, points, by_modifier, **{"As Instance": True})
    elif kind == "particles":
        holder = parts.add("plane", "Holder", size=0.2)
        holder.modifiers.new("Particles", "PARTICLE_SYSTEM")
        settings = holder.particle_systems[0].settings
        settings.count = settings.frame_start = settings.frame_end = 1
        settings.physics_type, settings.render_type, settings.instance_object = "NO", "OBJECT", cube
        settings.particle_size = 1.0
        holder.show_instancer_for_render = holder.show_instancer_for_viewport = False
    else:
        collection.objects.link(cube)
        scene.collection.objects.unlink(cube)
        if kind == "collection":
            holder = bpy.data.objects.new("Holder", None)
            holder.instance_type, holder.instance_collection = "COLLECTION", collection
        else:
            scene.collection.children.link(collection)
            holder = _by_nodes("GeometryNodeCollectionInfo", collection, points, by_modifier,
                               **{"Separate Children": kind.startswith("children")})
    if holder.name not in scene.collection.objects:
        scene.collection.objects.link(holder)
    return holder


@pytest.mark.thorough
@pytest.mark.parametrize("kind", [
    "object", "object on points", "object of the modifier on points", "children", "children on points",
    "children of the modifier on points", "particles", "collection", "whole collection", "whole collection on points"])
@pytest.mark.parametrize("hidden", [False, True])
def test_what_cycles_shows_is_read(blank, room, kind, hidden):
    scene, cube = blank.scene, parts.add("cube", "Cube", size=0.5)
    holder = _holder(kind, cube)
    holder.location = 0.0, 20.0, 1.0
    cube.hide_render = hidden
    scene.camera.location, scene.camera.rotation_euler = (0.0, 10.0, 1.0), (np.pi / 2, 0.0, 0.0)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.0
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.film_transparent = True
    copy = scene.copy()
    room("addon.rendering").with_cycles(copy)
    copy.cycles.samples = 4
    shown = room("addon.rendering").rendered(copy)[..., 3].max() > 0.5
    depsgraph = blank.evaluated_depsgraph_get()
    read = room("addon.reading").read_meshes(depsgraph, [holder], False)
    assert sum(len(placed.mesh.triangles) * len(placed.owners) for placed in read) == (12 if shown else 0)
