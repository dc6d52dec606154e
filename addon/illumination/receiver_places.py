"""Textures that are laid out by the object they are on, shown on another one: by attributes that know where they are.

A mesh of light has other corners and another box than what it lies on. Nodes that ask for the object's own coordinates
are given those of what is lit, in a copy of its material.
"""
from __future__ import annotations

from collections.abc import Iterable

import bpy

from .. import compat
from ..faults import AllOrNothing, unused
from ..reading import all_nodes
from ..writing.nodes.box_projection import project_by
from ..writing.nodes.shader_builder import ShaderBuilder

MARK = "reflection_mesh_adds_light"
PLACES = {"Generated": "lit_generated", "Object": "lit_object"}
"""Outputs of the node Texture Coordinate, and the attributes that stand for them."""
NORMAL = "Normal"
OF_THE_OBJECT = {"OBJECT_INFO": None, "TEX_COORD": {"Normal"}, "HAIR_INFO": None, "PARTICLE_INFO": None,
                 "NEW_GEOMETRY": {"Normal", "Tangent", "True Normal", "Pointiness", "Random Per Island", "Parametric"}}
"""What nothing stands for, all outputs or some: it is the mesh of light's own."""


def places_asked(materials: list) -> list[str]:
    """Return the outputs of Texture Coordinate that materials use, explicitly or as default of textures."""
    found = {name for material in materials if material is not None and compat.uses_nodes(material)
             for name in asked_by(all_nodes(material.node_tree))}
    return [name for name in PLACES if name in found]


def asked_by(nodes: Iterable[bpy.types.Node]) -> set[str]:
    """Return the coordinates of the object that nodes read: normals as `NORMAL`, UV maps as `uv(name)`, and stored
    attributes as `stored(name)`.
    """
    return {name for node in nodes for name in (*_asked(node), *_stored(node))}


def uv(name: str) -> str:
    """Return the name for coordinates of a UV map; of the active one if `name` is empty."""
    return f"UV {name}"


def stored(name: str) -> str:
    """Return the name for a colour or another attribute of an object; for its active colour if `name` is empty."""
    return f"Stored {name}"


def show_by_places(tree: bpy.types.NodeTree, whole: AllOrNothing, places: dict = PLACES) -> None:
    """Replace coordinates in the nodes of a tree, which must be our own, by the attributes in `places`. Groups that use
    any are copied.
    """
    for node in list(tree.nodes):
        if node.type == "GROUP" and node.node_tree is not None and any(
                name in places for name in asked_by(all_nodes(node.node_tree))):
            node.node_tree = node.node_tree.copy()
            node.node_tree[MARK] = True
            whole.undo(bpy.data.node_groups.remove, node.node_tree)
            show_by_places(node.node_tree, whole, places)
        for name, targets in (_asked(node) | _stored(node)).items():
            if name not in places:
                continue
            place = tree.nodes.new("ShaderNodeAttribute")
            place.attribute_name, place.location = places[name], (node.location[0] - 200.0, node.location[1])
            for socket in targets:
                told = socket.links[0].from_socket.name if socket.is_linked else "Vector"
                tree.links.new(place.outputs[told if name in _stored(node) else "Vector"], socket)
            if name == NORMAL and node.type == "TEX_IMAGE":
                project_by(ShaderBuilder(tree), node, place.outputs["Vector"])


def asks_for_more(tree: bpy.types.NodeTree) -> bool:
    """Return True if nodes read data of the object that no attribute provides."""
    for node in all_nodes(tree):
        if node.type in OF_THE_OBJECT:
            outputs = OF_THE_OBJECT[node.type]
            if any(socket.is_linked for socket in node.outputs if outputs is None or socket.name in outputs):
                return True
        if node.type == "ATTRIBUTE" and node.attribute_type != "GEOMETRY" and any(
                socket.is_linked for socket in node.outputs):
            return True
    return False


def forget_groups() -> None:
    """Remove unused copies of groups; nested ones last."""
    while abandoned := unused([group for group in bpy.data.node_groups if group.get(MARK)]):
        bpy.data.batch_remove(abandoned)


def _asked(node: bpy.types.Node) -> dict[str, list]:
    """Return the coordinates that a node provides or takes by default, and the sockets that use them."""
    def fed(output: bpy.types.NodeSocket) -> list:
        return [link.to_socket for link in output.links]
    if node.type == "TEX_COORD" and not node.from_instancer:
        found = {name: fed(node.outputs[name]) for name in (*PLACES, NORMAL) if name != "Object" or node.object is None}
        return {name: sockets for name, sockets in (found | {uv(""): fed(node.outputs["UV"])}).items() if sockets}
    if node.type == "UVMAP" and not node.from_instancer:
        sockets = fed(node.outputs[0])
        return {uv(node.uv_map): sockets} if sockets else {}
    vector = node.inputs.get("Vector") if node.type.startswith("TEX_") else None
    told = vector is None or not vector.enabled or vector.is_linked
    found = {} if told else {uv("") if node.type == "TEX_IMAGE" else "Generated": [vector]}
    # the normal chooses the side of the box
    return found | {NORMAL: []} if node.type == "TEX_IMAGE" and node.projection == "BOX" else found


def _stored(node: bpy.types.Node) -> dict[str, list]:
    """Return the stored attributes that a node reads, and the sockets that use them."""
    if node.type not in {"ATTRIBUTE", "VERTEX_COLOR"} or getattr(node, "attribute_type", "GEOMETRY") != "GEOMETRY":
        return {}
    name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
    sockets = [link.to_socket for output in node.outputs for link in output.links if output.name != "Alpha"]
    return {stored(name): sockets} if sockets else {}
