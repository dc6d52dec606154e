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

# as Blender holds them, in single precision: a tenth there is more than 0.1
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
    """Return `mirror_roughness` without a look at images that have not been read: 0 where only they could tell."""
    try:
        return mirror_roughness(material, read=False)
    except Unread:
        return 0.0


def mirror_roughness(material: bpy.types.Material | None, read: bool = True) -> float | None:
    """Return how rough a material is that is a mirror, sharp or not: its surface is metal or gloss and nothing else.

    Of textures the median counts, of the roughness where the surface is metal; inf where nodes do not tell it. None
    for what is no mirror, and for what is metal on less than half of it.

    Parameters
    ----------
    read : bool
        Whether images are read that have not been.

    Raises
    ------
    Unread
        Where it is up to an image that is not to be read.
    """
    if material is None:
        return None
    if not compat.uses_nodes(material):
        return float(material.roughness) if material.metallic >= FULL_METALLIC else None
    found = [_roughness(shader, groups, read) for shader, groups in shaders_of(material.node_tree)]
    return None if not found or None in found else max(found)


def which_reflect(materials: Sequence[bpy.types.Material | None]) -> list[bool]:
    """Return for each material of a mirror whether its faces reflect.

    Those do that are sharp mirrors; where there are none the rough ones, and where there are none of these all.
    """
    roughness = [mirror_roughness(material) for material in materials]
    sharp = [value is not None and value <= SHARP_ROUGHNESS for value in roughness]
    rough = [value is not None for value in roughness]
    return next((found for found in (sharp, rough) if any(found)), [True] * len(materials))


def shines(material: bpy.types.Material | None) -> bool:
    """Whether what is no mirror mirrors a little as well: a gloss that is mixed in, or a Principled BSDF that has
    a coat, or is not told to have no specular."""
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
    """Whether a Principled BSDF is coated with what mirrors."""
    weight = shader.inputs["Coat Weight"]
    return (weight.is_linked or weight.default_value > 0.0) and _at_most(shader, "Coat Roughness", SHARP_ROUGHNESS)


def is_exact(material: bpy.types.Material | None) -> bool:
    """Whether all that mirrors in a material does so without any roughness."""
    if material is None or not compat.uses_nodes(material):
        return False
    shaders = [node for node in all_nodes(material.node_tree) if node.type in MIRRORS | ROUGHENED]
    return bool(shaders) and all(not shader.inputs["Roughness"].is_linked and _at_most(shader, "Roughness", 0.0)
                                 for shader in shaders)


def emits(material: bpy.types.Material | None) -> bool:
    """Whether a material shows what it emits, and no lamp changes it."""
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
            # as most materials are, of which each redraw asks
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
