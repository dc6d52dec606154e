"""Compute the share of a surface's colour that it reflects diffusely, as Cycles computes it."""
from __future__ import annotations

import bpy

from ..reading.materials import index_of, upright
from ..writing.nodes.shader_builder import ShaderBuilder, given

SHARES = ("Metallic", "Transmission Weight", "Alpha")
# fits to Cycles' gloss at the roughnesses 0.5 and 1, from normal incidence to 70 degrees
FADES, FADES_BY = 0.65, 3.3  # loss of reflectance at roughness 1, and exponent of the roughness
SPREADS = 3.4  # loss of the rise towards grazing angles


def diffuse_share(tree: bpy.types.NodeTree, shader: bpy.types.Node) -> float | bpy.types.NodeSocket:
    """Return the share of its colour that a Diffuse or Principled BSDF reflects. Metal and glass reflect none,
    transparency and the gloss reduce it.
    """
    if shader.type != "BSDF_PRINCIPLED":
        return 1.0
    build, share = ShaderBuilder(tree), 1.0
    metal, glass, opaque = (given(shader.inputs[name]) for name in SHARES)
    for part in (_left(build, metal), _left(build, glass), opaque):
        share = _times(build, share, part)
    return _times(build, share, _left(build, _gloss(build, shader)))


def _gloss(build: ShaderBuilder, shader: bpy.types.Node) -> float | bpy.types.NodeSocket:
    """Return the reflectance of the layer over the colour, with linked sockets at their unlinked value. It is Fresnel's
    share, reduced for rough layers, with a flatter rise.
    """
    straight, rough = upright(shader), shader.inputs["Roughness"].default_value
    if not straight > 0.0:
        return 0.0
    fresnel = build.add("ShaderNodeFresnel")
    fresnel.inputs["IOR"].default_value = index_of(shader)
    kept = 1.0 - FADES * rough**FADES_BY
    rise = kept / (1.0 + SPREADS * rough**2)
    return build.calculated("ADD", build.calculated("MULTIPLY", fresnel.outputs[0], rise), (kept - rise) * straight)


def _left(build: ShaderBuilder, taken: float | bpy.types.NodeSocket) -> float | bpy.types.NodeSocket:
    return 1.0 - taken if isinstance(taken, float) else build.calculated("SUBTRACT", 1.0, taken)


def _times(build: ShaderBuilder, one: float | bpy.types.NodeSocket,
           other: float | bpy.types.NodeSocket) -> float | bpy.types.NodeSocket:
    if isinstance(one, float) and isinstance(other, float):
        return one * other
    if 1.0 in (one, other):
        return other if one == 1.0 else one
    return build.calculated("MULTIPLY", one, other)
