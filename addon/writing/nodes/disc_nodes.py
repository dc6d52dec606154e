"""Geometry Nodes that draw a point result: a disc at each point, as faces with the names and materials of a mesh's."""
from __future__ import annotations

import math

import bpy

from ...faults import AllOrNothing
from ..arrays import DISC_SCALE
from ..arrays import UV_MAP as LIGHT
from .node_builder import Builder

MODIFIER = "Reflection Points"
SIDES = 6  # sides of the polygon around each circle, so that touching discs leave no gap
FACE_NUMBERS = ("source_object", "source_face", "mirror_face")


def show_discs(obj: bpy.types.Object, uv_maps: list, whole: AllOrNothing) -> None:
    """Draw a disc at each point of a result with a Geometry Nodes modifier. A present one gets new nodes.

    Parameters
    ----------
    obj : bpy.types.Object
        A result whose mesh has loose points.
    uv_maps : list of str
        Names of the UV maps that the points have as attributes. The discs get them at their corners.
    whole : AllOrNothing
        Removes what was added and restores the present modifier's nodes if its block fails.
    """
    tree = bpy.data.node_groups.new(f"{obj.name} Points", "GeometryNodeTree")
    whole.undo(bpy.data.node_groups.remove, tree)
    _draw_discs(tree, uv_maps)
    modifier = _modifier_of(obj)
    if modifier is None:
        modifier = obj.modifiers.new(MODIFIER, "NODES")
        whole.undo(obj.modifiers.remove, modifier)
    old = modifier.node_group
    whole.undo(setattr, modifier, "node_group", old)
    modifier.node_group = tree
    whole.after(forget_nodes, old)


def hide_discs(obj: bpy.types.Object) -> None:
    """Take the modifier away, where there is one, and its nodes, where nothing else uses them."""
    modifier = _modifier_of(obj)
    if modifier is not None:
        old = modifier.node_group
        obj.modifiers.remove(modifier)
        forget_nodes(old)


def disc_nodes(obj: bpy.types.Object) -> bpy.types.NodeTree | None:
    """Return the nodes that draw the discs of `obj`; None if there are none."""
    modifier = _modifier_of(obj)
    return None if modifier is None else modifier.node_group


def forget_nodes(group: bpy.types.NodeTree | None) -> None:
    """Remove nodes that nothing uses any more."""
    if group is not None and group.users == 0 and group.library is None:
        bpy.data.node_groups.remove(group)


def _modifier_of(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    found = obj.modifiers.get(MODIFIER)
    return found if found is not None and found.type == "NODES" else None


def _draw_discs(tree: bpy.types.NodeTree, uv_maps: list) -> None:
    """Discs on the points by their `disc_rotation` and `disc_scale`; what belongs to faces and corners goes there."""
    tree.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    builder = Builder(tree)
    points = builder.add("NodeGroupInput").outputs[0]
    disc = builder.add("GeometryNodeMeshCircle", fill_type="NGON")
    disc.inputs["Vertices"].default_value = SIDES
    disc.inputs["Radius"].default_value = 1.0 / math.cos(math.pi / SIDES)
    instances = builder.add("GeometryNodeInstanceOnPoints")
    builder.join(points, instances.inputs["Points"])
    builder.join(disc.outputs["Mesh"], instances.inputs["Instance"])
    builder.join(builder.read("disc_rotation", "QUATERNION"), instances.inputs["Rotation"])
    builder.join(builder.read(DISC_SCALE, "FLOAT_VECTOR"), instances.inputs["Scale"])
    geometry = instances.outputs["Instances"]
    for attribute in ("disc_rotation", DISC_SCALE):
        geometry = builder.through("GeometryNodeRemoveAttribute", geometry, Name=attribute)
        points = builder.through("GeometryNodeRemoveAttribute", points, Name=attribute)
    geometry = builder.through("GeometryNodeRealizeInstances", geometry)
    # the loose points come along for their materials: discs have none of their own
    joined = builder.add("GeometryNodeJoinGeometry")
    builder.join(geometry, joined.inputs[0])
    builder.join(points, joined.inputs[0])
    materials = builder.add("GeometryNodeSetMaterialIndex")
    builder.join(joined.outputs[0], materials.inputs["Geometry"])
    builder.join(builder.read("source_material", "INT"), materials.inputs["Material Index"])
    geometry = materials.outputs["Geometry"]
    for attribute in FACE_NUMBERS:
        geometry = builder.moved(geometry, attribute, "INT", "INT", "FACE")
    # the first map is what solid view and exporters take: that of light, where there is light
    geometry = _where_known(builder, points, LIGHT, geometry)
    for attribute in uv_maps:
        geometry = builder.moved(geometry, attribute, "FLOAT_VECTOR", "FLOAT2", "CORNER")
    builder.join(geometry, builder.add("NodeGroupOutput").inputs[0])


def _where_known(builder: Builder, points: bpy.types.NodeSocket, uv_map: str,
                 geometry: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Return `geometry` with a UV map at its corners if the points have it, else unchanged."""
    known = builder.add("GeometryNodeInputNamedAttribute", data_type="FLOAT_VECTOR")
    known.inputs["Name"].default_value = uv_map
    # take the value of the first point, since a switch of geometry needs one value for all points
    first = builder.add("GeometryNodeSampleIndex", data_type="BOOLEAN", domain="POINT")
    builder.join(points, first.inputs["Geometry"])
    builder.join(known.outputs["Exists"], next(socket for socket in first.inputs
                                               if socket.name == "Value" and socket.enabled))
    choice = builder.add("GeometryNodeSwitch", input_type="GEOMETRY")
    builder.join(first.outputs[0], choice.inputs["Switch"])
    builder.join(geometry, choice.inputs["False"])
    builder.join(builder.moved(geometry, uv_map, "FLOAT_VECTOR", "FLOAT2", "CORNER"), choice.inputs["True"])
    return choice.outputs["Output"]
