"""Select the shader of each face by its material, for mirrors with several materials."""
from __future__ import annotations

from collections.abc import Callable, Sequence

from ..writing.nodes.shader_builder import ShaderBuilder

MATERIAL = "mirror_material"
"""The attribute with the number, among those of the mirror that reflect, of the material on which a face lies."""


def by_material(build: ShaderBuilder, parts: Sequence, mixed: Callable):
    """Mix `parts` so that each face shows the part that belongs to its material, by the attribute `MATERIAL`.

    Parameters
    ----------
    parts : sequence
        One value per reflecting material of the mirror, in their order.
    mixed : callable
        `mixed(factor, first, second)` returns a mix of two parts.
    """
    shown, number = parts[0], None
    for place, part in enumerate(parts[1:], 1):
        number = number or build.add("ShaderNodeAttribute", attribute_name=MATERIAL).outputs["Fac"]
        shown = mixed(build.calculated("COMPARE", number, float(place)), shown, part)
    return shown
