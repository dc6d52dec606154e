"""The colour of a metal by the angle at which it is seen."""
from __future__ import annotations

import bpy

from ..writing.nodes.shader_builder import ShaderBuilder

BLACK, WHITE = (0.0, 0.0, 0.0, 1.0), (1.0, 1.0, 1.0, 1.0)
SEVENTH = 1.0 / 7.0  # the cosine of 82 degrees


def metal_colour(build: ShaderBuilder, tint, edge) -> bpy.types.NodeSocket:
    """A socket that tells it of a `tint` seen upright and an `edge` tint, colours or sockets, as the Principled and the
    Metallic BSDF have it.

    C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994; less what the edge tint takes of that,
    most at 82 degrees: C. Kulla, A. Conty, "Revisiting Physically Based Shading at Imageworks", 2017.
    """
    away = build.add("ShaderNodeLayerWeight")
    away.inputs["Blend"].default_value = 0.5
    away = away.outputs["Facing"]
    fifth = build.calculated("POWER", away, 5.0)
    schlick = build.blended("MIX", fifth, tint, WHITE)
    if isinstance(edge, tuple) and min(edge[:3]) >= 1.0:
        return schlick
    bend = build.calculated("MULTIPLY", build.calculated("MULTIPLY", fifth, away),
                            build.calculated("SUBTRACT", 1.0, away))
    share = build.calculated("DIVIDE", bend, SEVENTH * (1.0 - SEVENTH)**6)
    at_most = build.blended("MULTIPLY", 1.0, build.blended("MIX", (1.0 - SEVENTH)**5, tint, WHITE),
                            build.blended("SUBTRACT", 1.0, WHITE, edge))
    return build.blended("SUBTRACT", 1.0, schlick, build.blended("MIX", share, BLACK, at_most))
