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
    away = _away(build)
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


def conductor_colour(build: ShaderBuilder, index, extinction) -> bpy.types.NodeSocket:
    """A socket that tells it of a refractive `index` and an `extinction` coefficient, vectors or sockets, as the
    Metallic BSDF has it before Blender 5.0; of metals Fresnel's own formula is within half a per cent of that.

    M. Pharr, G. Humphreys, "Physically Based Rendering", 2nd edition, section 8.2.1.
    """
    cosine = build.calculated("SUBTRACT", 1.0, _away(build))
    square = build.calculated("MULTIPLY", cosine, cosine)
    size = build.vector("ADD", build.vector("MULTIPLY", index, index),
                        build.vector("MULTIPLY", extinction, extinction))
    bend = build.vector("SCALE", index, Scale=build.calculated("MULTIPLY", 2.0, cosine))
    polarised = [build.vector("DIVIDE", build.vector("SUBTRACT", whole, bend), build.vector("ADD", whole, bend))
                 for whole in (build.vector("ADD", build.vector("SCALE", size, Scale=square), (1.0, 1.0, 1.0)),
                               build.vector("ADD", size, square))]
    return build.vector("SCALE", build.vector("ADD", *polarised), Scale=0.5)


def _away(build: ShaderBuilder) -> bpy.types.NodeSocket:
    """Return one minus the cosine of the viewing angle."""
    node = build.add("ShaderNodeLayerWeight")
    node.inputs["Blend"].default_value = 0.5
    return node.outputs["Facing"]
