"""What a mirror of several materials makes of light: each of its faces as its own material does."""
from __future__ import annotations

from collections.abc import Callable, Sequence

from ..writing.nodes.shader_builder import ShaderBuilder

MATERIAL = "mirror_material"
"""The attribute with the number, among those of the mirror that reflect, of the material on which a face lies."""


def by_material(build: ShaderBuilder, parts: Sequence, mixed: Callable):
    """One of the `parts`, which stand for the materials in their order; `mixed` makes one of two by a share."""
    shown, number = parts[0], None
    for place, part in enumerate(parts[1:], 1):
        number = number or build.add("ShaderNodeAttribute", attribute_name=MATERIAL).outputs["Fac"]
        shown = mixed(build.calculated("COMPARE", number, float(place)), shown, part)
    return shown
