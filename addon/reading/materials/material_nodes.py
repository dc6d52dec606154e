"""The nodes of a material, those in groups too, where they end, and which attributes of a mesh they ask for."""
from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy

from ... import compat

# property in which each type of node stores the name of the attribute that it reads
NAMES = {"ATTRIBUTE": "attribute_name", "VERTEX_COLOR": "layer_name", "UVMAP": "uv_map"}


def all_nodes(tree: bpy.types.NodeTree | None) -> Iterator[bpy.types.Node]:
    """Yield the nodes of a tree and of all groups in it, each tree once."""
    return _nodes(tree, set())


def feeding(*nodes: bpy.types.Node) -> list[bpy.types.Node]:
    """Return the nodes that feed some nodes, directly or through other nodes."""
    found: dict[bpy.types.Node, None] = {}
    left = list(nodes)
    while left:
        for source in [link.from_node for socket in left.pop().inputs for link in socket.links]:
            if source not in found:
                found[source] = None
                left.append(source)
    return list(found)


def shown_output(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """Return the active output node of the tree of a material, a light or a world: the one for Cycles if there is one,
    else the one for EEVEE. Return None if the tree has no output.
    """
    return tree.get_output_node("CYCLES") or tree.get_output_node("EEVEE")


def is_displaced(material: bpy.types.Material | None) -> bool:
    """Return True for a material that moves surfaces in renders, and not only bends their normals."""
    output = shown_output(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    return (output is not None and material.displacement_method != "BUMP" and output.inputs["Displacement"].is_linked)


def one_output(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """Keep only the shown output node of a tree, make it the output for all render engines, and return it.

    The shown one is that of `shown_output`. All others are deleted, so the tree should be a copy. Return None if the
    tree has no output node.
    """
    output = shown_output(tree)
    if output is not None:
        for other in [node for node in tree.nodes if node.type == output.type and node != output]:
            tree.nodes.remove(other)
        output.target, output.is_active_output = "ALL", True
    return output


def asked_attributes(materials: Iterable[bpy.types.Material | None]) -> set[str]:
    """Return the names of the mesh attributes that `materials` read."""
    return {getattr(node, NAMES[node.type]) for material in materials
            if material is not None and compat.uses_nodes(material)
            for node in all_nodes(material.node_tree)
            # an attribute may be asked of the object or of the view layer as well
            if node.type in NAMES and getattr(node, "attribute_type", "GEOMETRY") == "GEOMETRY"} - {""}


def _nodes(tree: bpy.types.NodeTree | None, seen: set) -> Iterator[bpy.types.Node]:
    if tree is None or tree.as_pointer() in seen:
        return
    seen.add(tree.as_pointer())
    for node in tree.nodes:
        yield node
        if node.type == "GROUP":
            yield from _nodes(node.node_tree, seen)
