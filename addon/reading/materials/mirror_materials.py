"""Recognise mirror materials: sharp Glossy or Metallic BSDFs, or sharp metallic Principled BSDFs."""
from __future__ import annotations

import math
from collections.abc import Sequence

import bpy
import numpy as np

from ... import compat
from .material_nodes import all_nodes
from .shader_graph import Groups, shaders_of, surface_shader, surface_shaders
from .texture_values import Inputs, Unknown, Unread

# Blender stores single precision, in which 0.1 is slightly more than 0.1
SHARP_ROUGHNESS = float(np.float32(0.1))
FULL_METALLIC = float(np.float32(0.9))
MIRRORS = {"BSDF_GLOSSY", "BSDF_METALLIC"}
"""Shaders that are nothing but a mirror where they are sharp."""
ROUGHENED = {"BSDF_PRINCIPLED", "BSDF_GLASS", "BSDF_REFRACTION"}


def is_mirror(material: bpy.types.Material | None) -> bool:
    """Return True for a material that is a sharp mirror by itself."""
    roughness = mirror_roughness(material)
    return roughness is not None and roughness <= SHARP_ROUGHNESS


def least_roughness(material: bpy.types.Material | None) -> float | None:
    """Return `mirror_roughness` without loading images. Return 0 if the roughness depends on an image that is not
    loaded.
    """
    try:
        return mirror_roughness(material, read=False)
    except Unread:
        return 0.0


def mirror_roughness(material: bpy.types.Material | None, read: bool = True) -> float | None:
    """Return the roughness of a mirror material, sharp or not: its surface consists of metal or gloss only.

    Textured roughness counts with its median where the surface is metal. Return inf if the nodes do not determine it.
    Return None for other materials, and for those that are metal on less than half of the surface.

    Parameters
    ----------
    read : bool
        Load images that are not loaded yet.

    Raises
    ------
    Unread
        If the roughness depends on an image that may not be loaded.
    """
    if material is None:
        return None
    if not compat.uses_nodes(material):
        return float(material.roughness) if material.metallic >= FULL_METALLIC else None
    found = [_roughness(shader, groups, read) for shader, groups in shaders_of(material.node_tree)]
    return None if not found or None in found else max(found)


def which_reflect(materials: Sequence[bpy.types.Material | None]) -> list[bool]:
    """Return for each material of a mirror (bool) if its faces reflect.

    Those do that are sharp mirrors; where there are none the rough ones, and where there are none of these all.
    """
    roughness = [mirror_roughness(material) for material in materials]
    sharp = [value is not None and value <= SHARP_ROUGHNESS for value in roughness]
    rough = [value is not None for value in roughness]
    return next((found for found in (sharp, rough) if any(found)), [True] * len(materials))


def shines(material: bpy.types.Material | None) -> bool:
    """Return True for a material with a weak reflection: any mixed-in gloss, or a Principled BSDF with a coat or a
    non-zero specular level.
    """
    if material is None or not compat.uses_nodes(material):
        return False
    return any(shader.type in MIRRORS or shader.type == "BSDF_PRINCIPLED" and (
        has_sharp_coat(shader) or not _at_most(shader, "Specular IOR Level", 0.0))
        for shader in surface_shaders(material.node_tree))


def mirrors_in_part(material: bpy.types.Material | None) -> bool:
    """Return True for a material of which any shader mirrors sharply, as glass, water and lacquer do."""
    if material is None or not compat.uses_nodes(material):
        return False
    return any(is_sharp(shader, groups) and shader.type in {*MIRRORS, "BSDF_PRINCIPLED", "BSDF_GLASS"}
               or shader.type == "BSDF_PRINCIPLED" and has_sharp_coat(shader)
               for shader, groups in shaders_of(material.node_tree))


def is_sharp(shader: bpy.types.Node, groups: Groups = ()) -> bool:
    """Return True for a shader whose roughness is near 0 on most of the surface."""
    return _at_most(shader, "Roughness", SHARP_ROUGHNESS, groups)


def is_metal(shader: bpy.types.Node, groups: Groups = ()) -> bool:
    """Return True for a shader that is metal on most of the surface."""
    if shader.type != "BSDF_PRINCIPLED":
        return shader.type in MIRRORS
    metallic = _median(shader, "Metallic", groups)
    return metallic is not None and metallic >= FULL_METALLIC


def has_sharp_coat(shader: bpy.types.Node) -> bool:
    """Return True for a Principled BSDF with a coat of low roughness."""
    weight = shader.inputs["Coat Weight"]
    return (weight.is_linked or weight.default_value > 0.0) and _at_most(shader, "Coat Roughness", SHARP_ROUGHNESS)


def is_exact(material: bpy.types.Material | None) -> bool:
    """Return True if all glossy shaders in a material have a roughness of exactly 0."""
    if material is None or not compat.uses_nodes(material):
        return False
    shaders = [node for node in all_nodes(material.node_tree) if node.type in MIRRORS | ROUGHENED]
    return bool(shaders) and all(not shader.inputs["Roughness"].is_linked and _at_most(shader, "Roughness", 0.0)
                                 for shader in shaders)


def emits(material: bpy.types.Material | None) -> bool:
    """Return True for a material whose surface is an Emission shader, so that lamps do not change it."""
    if material is None or not compat.uses_nodes(material):
        return False
    shader = surface_shader(material.node_tree)
    return shader is not None and shader.type == "EMISSION"


def _roughness(shader: bpy.types.Node, groups: Groups, read: bool) -> float | None:
    """Return the roughness of a shader as `mirror_roughness` does of a material."""
    inputs, metal = Inputs(shader, groups, read), np.array([True])
    if shader.type == "BSDF_PRINCIPLED":
        metallic = shader.inputs["Metallic"]
        if not metallic.is_linked and metallic.default_value < FULL_METALLIC:
            # most materials end here, and every redraw asks
            return None
        try:
            metal = inputs["Metallic"] >= FULL_METALLIC
        except Unread:
            raise
        except Unknown:
            return None
        if metal.mean() < 0.5:
            return None
    elif shader.type not in MIRRORS:
        return None
    try:
        metal, values = np.broadcast_arrays(metal, inputs["Roughness"])
    except Unread:
        raise
    except Unknown:
        return math.inf
    return float(np.median(values[metal]))


def _median(shader: bpy.types.Node, name: str, groups: Groups) -> float | None:
    try:
        return float(np.median(Inputs(shader, groups)[name]))
    except Unknown:
        return None


def _at_most(shader: bpy.types.Node, name: str, most: float, groups: Groups = ()) -> bool:
    value = _median(shader, name, groups) if name in shader.inputs else None
    return value is not None and value <= most
