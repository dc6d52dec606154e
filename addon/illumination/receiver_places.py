"""Textures that are laid out by the object they are on, shown on another one: by attributes that know where they are.

A mesh of light has other corners and another box than what it lies on. Nodes that ask for the object's own coordinates
are given those of what is lit, in a copy of its material.
"""
from __future__ import annotations

from collections.abc import Iterable

import bpy

from .. import compat
from ..faults import AllOrNothing
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
    """Outputs of Texture Coordinate that materials ask for, as they are or as what textures take without being told."""
    found = {name for material in materials if material is not None and compat.uses_nodes(material)
             for name in asked_by(all_nodes(material.node_tree))}
    return [name for name in PLACES if name in found]


def asked_by(nodes: Iterable[bpy.types.Node]) -> set[str]:
    """Coordinates of the object that nodes ask for, its normals as `NORMAL`, those of its UV maps as `uv` and the map's
    name; and what is stored on it, as `stored` and its name."""
    return {name for node in nodes for name in (*_asked(node), *_stored(node))}


def uv(name: str) -> str:
    """What the coordinates of a UV map are called, those of the active one where it has no name."""
    return f"UV {name}"


def stored(name: str) -> str:
    """What a colour or another attribute of an object is called, its active colour where it has no name."""
    return f"Stored {name}"


def show_by_places(tree: bpy.types.NodeTree, whole: AllOrNothing, places: dict = PLACES) -> None:
    """Let the nodes of a tree, which is our own, ask for the attributes that stand for `places`; groups that ask for
    any are copied."""
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
    """Whether nodes ask the object that shows them for what no attribute stands for."""
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
    """Remove the copies of groups that nothing uses any more, those within others after these."""
    while abandoned := [group for group in bpy.data.node_groups if group.get(MARK) and not group.users]:
        for group in abandoned:
            bpy.data.node_groups.remove(group)


def _asked(node: bpy.types.Node) -> dict[str, list]:
    """The coordinates that a node stands for or takes without being told, and the sockets that they go to."""
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
    # which side of a box shows its picture the normal tells
    return found | {NORMAL: []} if node.type == "TEX_IMAGE" and node.projection == "BOX" else found


def _stored(node: bpy.types.Node) -> dict[str, list]:
    """What is stored on the object that a node reads, and the sockets that it goes to."""
    if node.type not in {"ATTRIBUTE", "VERTEX_COLOR"} or getattr(node, "attribute_type", "GEOMETRY") != "GEOMETRY":
        return {}
    name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
    sockets = [link.to_socket for output in node.outputs for link in output.links if output.name != "Alpha"]
    return {stored(name): sockets} if sockets else {}
