"""The shaders that a material is mixed, added or grouped of, each with what these mixes leave to it."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ... import compat
from ...reading.materials import MIXING, Groups, fed_by, is_metal, is_sharp, outermost, shown_output
from .coat import WHOLE, Coat, share_of

BENT = ("Normal", "Coat Normal")


@dataclass(frozen=True)
class Lobe:
    """A shader of a material.

    Attributes
    ----------
    shader : bpy.types.Node
    share : Coat
        Its share in the mixes on the way to it.
    known : bool
        True if that holds all over the material.
    groups : tuple of bpy.types.Node
        The groups that contain it, from outside to inside.
    """

    shader: bpy.types.Node
    share: Coat
    known: bool
    groups: Groups

    def told(self, name: str) -> tuple[np.ndarray, bool]:
        """Return the value of an input socket of the shader, a number or a colour (3,), and True if nothing is linked.

        If the socket is fed by an input of its node group, the value is that of the group node's socket. If something
        is linked there, the value is the socket's default.
        """
        socket, _ = outermost(self.shader.inputs[name], self.groups)
        value = np.array(socket.default_value, dtype=np.float64)
        return value[:3] if value.ndim else value, not socket.is_linked

    @property
    def is_sharp(self) -> bool:
        """Return True if its roughness is near 0."""
        return is_sharp(self.shader, self.groups)

    @property
    def is_metal(self) -> bool:
        """Return True if it is nothing but a mirror where it is sharp."""
        return is_metal(self.shader, self.groups)


def lobes_of(socket: bpy.types.NodeSocket, share: Coat = WHOLE, known: bool = True, groups: Groups = ()) -> list[Lobe]:
    """Return the shaders behind a shader socket. `share` is what the mixes before it leave."""
    source, groups = fed_by(socket, groups)
    if source is None:
        return []
    node = source.node
    if node.type not in MIXING:
        return [Lobe(node, share, known, groups)]
    if node.type == "ADD_SHADER":
        return [lobe for one in node.inputs for lobe in lobes_of(one, share, known, groups)]
    factor, *both = node.inputs
    part, told = share_of(outermost(factor, groups)[0])
    return [lobe for place, one in enumerate(both)
            for lobe in lobes_of(one, replace(part, rest=place == 0, within=share), known and told, groups)]


def is_bumped(material: bpy.types.Material | None) -> bool:
    """Return True if the nodes of a material bend the normals of its surface or displace it."""
    output = shown_output(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    return output is not None and (output.inputs["Displacement"].is_linked or any(
        lobe.shader.inputs[name].is_linked for lobe in lobes_of(output.inputs["Surface"])
        for name in BENT if name in lobe.shader.inputs))

