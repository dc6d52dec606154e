"""What mirrors take of the light that the eye sees by more than one of them."""
from __future__ import annotations

import bpy
import numpy as np

from ..illumination import MirrorColours, Tint
from ..reading import corner_vertices, numbers
from ..writing import LATER_COSINE, LATER_MATERIAL
from ..writing.nodes.shader_builder import ShaderBuilder

LATER_TINT = "later_tint"
"""The attribute with what all mirrors but the first leave of the light, in red, green and blue."""
ANGLES = np.linspace(0.0, 1.0, 9)  # cosines at which a perfect mirror is told from others


def takes_later(result: bpy.types.Object) -> bool:
    """Whether mirrors that a result's first one shows take any of the light."""
    return (LATER_MATERIAL.format(2) in result.data.attributes
            and any((tint.at(ANGLES) < 1.0).any() for tint in _tints(result)))


def leave_later(build: ShaderBuilder, colour):
    """What they leave of light of a colour, a socket or the colour itself."""
    left = build.add("ShaderNodeAttribute", attribute_name=LATER_TINT).outputs["Vector"]
    return build.blended("MULTIPLY", 1.0, colour, left)


def write_later_tints(result: bpy.types.Object) -> None:
    """Tell each corner of a result what they leave of the light, by their materials as these are now."""
    mesh = result.data
    left, tints = np.ones((len(mesh.polygons), 3, 3)), _tints(result)
    if LATER_MATERIAL.format(2) in mesh.attributes:
        corners, count = corner_vertices(mesh), int(numbers(mesh, "bounces").max(initial=1))
        met = np.stack([numbers(mesh, LATER_MATERIAL.format(bounce)) for bounce in range(2, count + 1)], axis=1)
        cosine = np.stack([numbers(mesh, LATER_COSINE.format(bounce)) for bounce in range(2, count + 1)], axis=1)
        later = np.flatnonzero(met[:, 0] >= 0)
        left[later] = MirrorColours(tints, np.arange(len(tints))).left(
            met[later], cosine[corners[later]].astype(np.float64))
    written = mesh.attributes.get(LATER_TINT) or mesh.attributes.new(LATER_TINT, "FLOAT_VECTOR", "CORNER")
    written.data.foreach_set("vector", left.astype(np.float32).reshape(-1))


def _tints(result: bpy.types.Object) -> list[Tint]:
    return [Tint.of_material(entry.material) for entry in result.reflection_mesh.later_materials]
