"""Compute the diffuse colour of a surface as nodes: the colours of its shaders, mixed like the shaders."""
from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..faults import AllOrNothing
from ..reading.materials import MIRRORS
from ..writing.nodes.muted_nodes import take_out_muted
from ..writing.nodes.shader_builder import ShaderBuilder, given
from .diffuse_share import SHARES, diffuse_share
from .receiver_places import MARK

COLOURS = {"BSDF_PRINCIPLED": "Base Color", "BSDF_DIFFUSE": "Color", "SUBSURFACE_SCATTERING": "Color"}
"""Shaders that send diffuse light back, and the socket that tells in which colour."""
NONE = MIRRORS | {"BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSLUCENT", "EMISSION", "HOLDOUT"}
"""Shaders that send none back to the side it comes from."""
MIXED = {"MIX_SHADER", "ADD_SHADER"}
BLACK, GREY = (0.0, 0.0, 0.0, 1.0), (0.8, 0.8, 0.8, 1.0)


@dataclass(frozen=True)
class DiffuseColour:
    """The diffuse reflectance of a surface.

    Attributes
    ----------
    colour : tuple of float or bpy.types.NodeSocket
        Red, green, blue and 1, or a socket with the colour.
    share : float or bpy.types.NodeSocket
        Factor of the colour.
    known : bool
        True if this is the complete reflectance.
    by_nodes : bool
        True if nodes of the material determine it.
    """

    colour: tuple | bpy.types.NodeSocket = BLACK
    share: float | bpy.types.NodeSocket = 1.0
    known: bool = True
    by_nodes: bool = False


def diffuse_colour(tree: bpy.types.NodeTree, surface: bpy.types.NodeSocket, whole: AllOrNothing) -> DiffuseColour:
    """Return the diffuse colour of the shader linked to a socket. Nodes are added to the tree, which must be our own;
    groups are copied.
    """
    source = _source(surface)
    if source is None:
        return DiffuseColour()
    shader = source.node
    if shader.type in COLOURS:
        socket = shader.inputs[COLOURS[shader.type]]
        asked = (socket, *(shader.inputs[name] for name in SHARES if name in shader.inputs))
        return DiffuseColour(given(socket), diffuse_share(tree, shader), True, any(one.is_linked for one in asked))
    if shader.type in MIXED:
        return _mixed(tree, shader, [diffuse_colour(tree, socket, whole) for socket in shader.inputs
                                     if socket.type == "SHADER"])
    if shader.type == "GROUP" and shader.node_tree is not None:
        return _in_group(shader, source, whole)
    if shader.type in NONE:
        return DiffuseColour()
    colour = shader.inputs.get("Color")
    return DiffuseColour(GREY if colour is None else given(colour), known=False)


def _mixed(tree: bpy.types.NodeTree, shader: bpy.types.Node, parts: list[DiffuseColour]) -> DiffuseColour:
    build = ShaderBuilder(tree)
    first, second = (_product(build, part) for part in parts)
    known, by_nodes = all(part.known for part in parts), any(part.by_nodes for part in parts)
    if shader.type == "ADD_SHADER":
        both = build.vector("ADD", *(value if isinstance(value, bpy.types.NodeSocket) else value[:3]
                                     for value in (first, second)))
        return DiffuseColour(both, 1.0, known, by_nodes)
    factor = given(shader.inputs[0])
    return DiffuseColour(build.blended("MIX", factor, first, second), 1.0, known,
                         by_nodes or shader.inputs[0].is_linked)


def _product(build: ShaderBuilder, part: DiffuseColour) -> tuple | bpy.types.NodeSocket:
    """Return the colour times its share."""
    colour, share = part.colour, part.share
    if share == 1.0:
        return colour
    if isinstance(share, float) and not isinstance(colour, bpy.types.NodeSocket):
        return (*(value * share for value in colour[:3]), 1.0)
    return build.vector("SCALE", colour if isinstance(colour, bpy.types.NodeSocket) else colour[:3], Scale=share)


def _in_group(node: bpy.types.Node, source: bpy.types.NodeSocket, whole: AllOrNothing) -> DiffuseColour:
    """Return the colour of a shader in a group, from an additional output of a copy of the group."""
    if not node.node_tree.get(MARK):
        node.node_tree = node.node_tree.copy()
        node.node_tree[MARK] = True
        whole.undo(bpy.data.node_groups.remove, node.node_tree)
    group = node.node_tree
    take_out_muted(group)
    output = next((one for one in group.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output), None)
    if output is None:
        return DiffuseColour()
    inner = next(socket for socket in output.inputs if socket.identifier == source.identifier)
    found = diffuse_colour(group, inner, whole)
    added = group.interface.new_socket("Diffuse", in_out="OUTPUT", socket_type="NodeSocketColor").identifier
    place = next(socket for socket in output.inputs if socket.identifier == added)
    build = ShaderBuilder(group)
    build.feed(_product(build, found), place)
    outside = next(socket for socket in node.outputs if socket.identifier == added)
    return DiffuseColour(outside, 1.0, found.known, True)


def _source(socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """Return the socket of the node that feeds another socket, ignoring reroutes."""
    while socket.is_linked and socket.links[0].from_node.type == "REROUTE":
        socket = socket.links[0].from_node.inputs[0]
    return socket.links[0].from_socket if socket.is_linked else None
