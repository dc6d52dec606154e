"""Find materials that emit light."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import all_nodes

# names of the sockets for emission strength and colour, by node type
LIGHT = {"EMISSION": ("Strength", "Color"), "BSDF_PRINCIPLED": ("Emission Strength", "Emission Color")}
PAPER = 1.0  # emission strength that equals the light of white paper


def glows(material: bpy.types.Material | None) -> bool:
    """Return True if any node of `material` may emit light."""
    return (material is not None and compat.uses_nodes(material)
            and any(map(sends_light, all_nodes(material.node_tree))))


def sends_light(node: bpy.types.Node) -> bool:
    """Return True for a shader node that emits light: its strength and its colour are linked or not zero."""
    if node.type not in LIGHT:
        return False
    strength, colour = (node.inputs[name] for name in LIGHT[node.type])
    # files from before Blender 4 have black of strength 1
    return ((strength.is_linked or strength.default_value > 0.0)
            and (colour.is_linked or max(colour.default_value[:3]) > 0.0))


def outshines_paper(material: bpy.types.Material | None) -> bool:
    """Return True if `material` may emit more than white paper reflects, with a colour or a strength from other nodes.
    Linked colours count as white, linked strengths as large.
    """
    return (material is not None and compat.uses_nodes(material)
            and any(map(_outshines_paper, all_nodes(material.node_tree))))


def _outshines_paper(node: bpy.types.Node) -> bool:
    if node.type not in LIGHT:
        return False
    strength, colour = (node.inputs[name] for name in LIGHT[node.type])
    if strength.is_linked:
        return True
    return colour.is_linked and strength.default_value > PAPER
