"""What part of a surface's colour it sends back as diffuse light, as Cycles divides it."""
from __future__ import annotations

import bpy

from ..reading.materials import index_of, upright
from ..writing.nodes.shader_builder import ShaderBuilder, given

SHARES = ("Metallic", "Transmission Weight", "Alpha")
# of the gloss, as Cycles has it at the roughnesses 0.5 and 1, seen from upright to 70 degrees
FADES, FADES_BY = 0.65, 3.3  # how much less a rough one sends back, and how late
SPREADS = 3.4  # how much less it rises towards grazing


def diffuse_share(tree: bpy.types.NodeTree, shader: bpy.types.Node) -> float | bpy.types.NodeSocket:
    """The part of its colour that a Diffuse or Principled BSDF sends back: what is metal or glass sends none, what is
    transparent as much less, and what the gloss takes is gone."""
    if shader.type != "BSDF_PRINCIPLED":
        return 1.0
    build, share = ShaderBuilder(tree), 1.0
    metal, glass, opaque = (given(shader.inputs[name]) for name in SHARES)
    for part in (_left(build, metal), _left(build, glass), opaque):
        share = _times(build, share, part)
    return _times(build, share, _left(build, _gloss(build, shader)))


def _gloss(build: ShaderBuilder, shader: bpy.types.Node) -> float | bpy.types.NodeSocket:
    """What the layer over the colour sends back by itself, of values that are plugged off: Fresnel's share, and of a
    rough layer less of it, and less of its rise."""
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
