"""Which materials have a light of their own."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import all_nodes

# the sockets of each kind of node that tell how strong its light is, and of which colour
LIGHT = {"EMISSION": ("Strength", "Color"), "BSDF_PRINCIPLED": ("Emission Strength", "Emission Color")}
PAPER = 1.0  # the light that it has


def glows(material: bpy.types.Material | None) -> bool:
    """Whether a material may send light of its own, be it no more than a part of what is seen of it."""
    return (material is not None and compat.uses_nodes(material)
            and any(map(sends_light, all_nodes(material.node_tree))))


def sends_light(node: bpy.types.Node) -> bool:
    """Whether a node is a shader that has light of its own."""
    if node.type not in LIGHT:
        return False
    strength, colour = (node.inputs[name] for name in LIGHT[node.type])
    # files from before Blender 4 have black of strength 1
    return ((strength.is_linked or strength.default_value > 0.0)
            and (colour.is_linked or max(colour.default_value[:3]) > 0.0))


def outshines_paper(material: bpy.types.Material | None) -> bool:
    """Whether light of a material's own may be brighter than white paper, and goes by other nodes: what is linked may
    be white, and so strong."""
    return (material is not None and compat.uses_nodes(material)
            and any(map(_outshines_paper, all_nodes(material.node_tree))))


def _outshines_paper(node: bpy.types.Node) -> bool:
    if node.type not in LIGHT:
        return False
    strength, colour = (node.inputs[name] for name in LIGHT[node.type])
    if strength.is_linked:
        return True
    return colour.is_linked and strength.default_value > PAPER
