"""Which materials are mirrors: a sharp Glossy or Metallic BSDF, or a sharp metallic Principled BSDF."""
from __future__ import annotations

import bpy
import numpy as np

from ... import compat
from .material_nodes import all_nodes, shown_output
from .surface_shaders import surface_shaders

# as Blender holds them, in single precision: a tenth there is more than 0.1
SHARP_ROUGHNESS = float(np.float32(0.1))
FULL_METALLIC = float(np.float32(0.9))
MIRRORS = {"BSDF_GLOSSY", "BSDF_METALLIC"}
"""Shaders that are nothing but a mirror where they are sharp."""
ROUGHENED = {"BSDF_PRINCIPLED", "BSDF_GLASS", "BSDF_REFRACTION"}


def is_mirror(material: bpy.types.Material | None) -> bool:
    """Whether light leaves `material` as from a mirror: its surface shader is glossy with a roughness near 0.

    Values that a texture drives are not constant over the surface and make no mirror.
    """
    if material is None:
        return False
    if not compat.uses_nodes(material):
        return material.metallic >= FULL_METALLIC and material.roughness <= SHARP_ROUGHNESS
    shader = surface_shader(material.node_tree)
    if shader is None or not is_sharp(shader):
        return False
    if shader.type == "BSDF_PRINCIPLED":
        return _constant(shader, "Metallic", at_least=FULL_METALLIC)
    return shader.type in MIRRORS


def shines(material: bpy.types.Material | None) -> bool:
    """Whether what is no mirror mirrors a little as well: a gloss that is mixed in, or a Principled BSDF that has
    a coat, or is not told to have no specular."""
    if material is None or not compat.uses_nodes(material):
        return False
    return any(shader.type in MIRRORS or shader.type == "BSDF_PRINCIPLED" and (
        has_sharp_coat(shader) or not _constant(shader, "Specular IOR Level", at_most=0.0))
        for shader in surface_shaders(material.node_tree))


def is_sharp(shader: bpy.types.Node) -> bool:
    """Whether a shader's roughness is near 0 all over."""
    return _constant(shader, "Roughness", at_most=SHARP_ROUGHNESS)


def has_sharp_coat(shader: bpy.types.Node) -> bool:
    """Whether a Principled BSDF is coated with what mirrors."""
    weight = shader.inputs["Coat Weight"]
    return (weight.is_linked or weight.default_value > 0.0) and _constant(shader, "Coat Roughness",
                                                                          at_most=SHARP_ROUGHNESS)


def is_exact(material: bpy.types.Material | None) -> bool:
    """Whether all that mirrors in a material does so without any roughness."""
    if material is None or not compat.uses_nodes(material):
        return False
    shaders = [node for node in all_nodes(material.node_tree) if node.type in MIRRORS | ROUGHENED]
    return bool(shaders) and all(_constant(shader, "Roughness", at_most=0.0) for shader in shaders)


def surface_shader(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """The shader node behind the active output's Surface socket."""
    output = shown_output(tree)
    if output is None:
        return None
    socket = output.inputs["Surface"]
    # a chain of reroutes cannot be longer than the tree has nodes
    for _ in range(len(tree.nodes)):
        if not socket.is_linked:
            return None
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def _constant(node: bpy.types.Node, name: str, at_least: float = float("-inf"), at_most: float = float("inf")) -> bool:
    socket = node.inputs.get(name)
    return socket is not None and not socket.is_linked and at_least <= socket.default_value <= at_most


def emits(material: bpy.types.Material | None) -> bool:
    """Whether a material shows what it emits, and no lamp changes it."""
    if material is None or not compat.uses_nodes(material):
        return False
    shader = surface_shader(material.node_tree)
    return shader is not None and shader.type == "EMISSION"
