"""The shaders that a material is mixed, added or grouped of, each with what these mixes leave to it."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ... import compat
from ...reading.materials import SHARP_ROUGHNESS, shown_output
from .coat import WHOLE, Coat, share_of

BENT = ("Normal", "Coat Normal")


@dataclass(frozen=True)
class Lobe:
    """A shader of a material.

    Attributes
    ----------
    shader : bpy.types.Node
    share : Coat
        What the mixes on the way to it leave to it.
    known : bool
        Whether that is so all over the material.
    groups : tuple of bpy.types.Node
        The groups that it is in, from outside.
    """

    shader: bpy.types.Node
    share: Coat
    known: bool
    groups: tuple

    def told(self, name: str) -> tuple[np.ndarray, bool]:
        """The number, or red, green and blue (3,), that a socket is given, be it by a group's own socket; and whether
        nothing else is plugged into it."""
        socket, _ = _outside(self.shader.inputs[name], self.groups)
        value = np.array(socket.default_value, dtype=np.float64)
        return value[:3] if value.ndim else value, not socket.is_linked

    @property
    def is_sharp(self) -> bool:
        """Whether its roughness is near 0 all over."""
        if "Roughness" not in self.shader.inputs:
            return False
        roughness, known = self.told("Roughness")
        return known and bool(roughness <= SHARP_ROUGHNESS)


def lobes_of(socket: bpy.types.NodeSocket, share: Coat = WHOLE, known: bool = True, groups: tuple = ()) -> list[Lobe]:
    """The shaders behind a socket for shaders, of which `share` is left by what is before it."""
    socket, groups = _outside(socket, groups)
    if not socket.is_linked:
        return []
    source = socket.links[0].from_socket
    node = source.node
    if node.type == "GROUP" and node.node_tree is not None:
        ends = [one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output]
        inside = [one for end in ends for one in end.inputs if one.identifier == source.identifier]
        return [lobe for one in inside for lobe in lobes_of(one, share, known, (*groups, node))]
    if node.type == "ADD_SHADER":
        return [lobe for one in node.inputs for lobe in lobes_of(one, share, known, groups)]
    if node.type != "MIX_SHADER":
        return [Lobe(node, share, known, groups)]
    factor, *both = node.inputs
    part, told = share_of(_outside(factor, groups)[0])
    return [lobe for place, one in enumerate(both)
            for lobe in lobes_of(one, replace(part, rest=place == 0, within=share), known and told, groups)]


def is_bumped(material: bpy.types.Material | None) -> bool:
    """Whether the nodes of a material bend the normals of its surface, or move that."""
    output = shown_output(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    return output is not None and (output.inputs["Displacement"].is_linked or any(
        lobe.shader.inputs[name].is_linked for lobe in lobes_of(output.inputs["Surface"])
        for name in BENT if name in lobe.shader.inputs))


def _outside(socket: bpy.types.NodeSocket, groups: tuple) -> tuple[bpy.types.NodeSocket, tuple]:
    """The socket that tells what a socket takes, past reroutes and, where a group's input feeds it, that of the group's
    node; and the groups that it is in."""
    while socket.is_linked:
        source = socket.links[0].from_socket
        if source.node.type == "REROUTE":
            socket = source.node.inputs[0]
        elif source.node.type == "GROUP_INPUT" and groups:
            *outer, node = groups
            socket = next(one for one in node.inputs if one.identifier == source.identifier)
            groups = tuple(outer)
        else:
            break
    return socket, groups
