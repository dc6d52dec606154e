"""What share of light a mirror sends back that lets some of it into itself, by the angle."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...reading.materials import SHARP_ROUGHNESS, index_of, is_sharp, upright

LEAST = 1e-5  # refractive index
BY_COAT = ("Coat Weight", "Coat Roughness", "Coat IOR")


@dataclass(frozen=True)
class Coat:
    """The share of what mirrors in a material.

    Attributes
    ----------
    factor : float
    ior : float
        Where it is none of 0, the share is as much of what a dielectric of this refractive index reflects.
    from_within : bool
        Whether the inverse index counts at backs, as of what light meets from within.
    facing : float
        Where it is none of 0, the share is what the cosine, to this power, leaves.
    rest : bool
        Whether it is what all that leaves.
    opacity : float
        How opaque the material is: all of it counts as much.
    within : Coat, optional
        What is left to all of it, where it is mixed itself.
    """

    factor: float = 1.0
    ior: float = 0.0
    from_within: bool = False
    facing: float = 0.0
    rest: bool = False
    opacity: float = 1.0
    within: Coat | None = None

    def at(self, cosine: np.ndarray) -> np.ndarray:
        """The share by the cosine of the angle of incidence, negative at backs."""
        share, c = np.full(cosine.shape, self.factor), np.clip(np.abs(cosine), 0.0, 1.0)
        if self.ior:
            inside = (cosine < 0.0) & self.from_within
            share = self.factor * _reflectance(np.where(inside, 1.0 / self.ior, self.ior), c)
        elif self.facing:
            share = 1.0 - c**self.facing
        share = self.opacity * (1.0 - share if self.rest else share)
        return share if self.within is None else share * self.within.at(cosine)


def _reflectance(ior: np.ndarray, c: np.ndarray) -> np.ndarray:
    """What a dielectric reflects at the cosine c of the angle of incidence; all of it beyond the critical angle.

    As `fresnel_dielectric_cos` of Cycles' kernel has it.
    """
    g = np.sqrt(np.maximum(ior**2 - 1.0 + c**2, 0.0))
    a, b = (g - c) / np.maximum(g + c, 1e-300), (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return 0.5 * a**2 * (1.0 + b**2)


WHOLE = Coat()


@dataclass(frozen=True)
class Gloss:
    """What a shader that is no metal mirrors: a colour (3,), and its share by the angle, or, for what is metal in part,
    by the metal's Fresnel; whether that is known all over."""

    colour: np.ndarray
    coat: Coat
    metal: bool
    known: bool


def gloss_of(shader: bpy.types.Node | None) -> Gloss | None:
    """What glass, water, lacquer, or metal in part mirror; None where a shader does not mirror sharply."""
    if shader is None:
        return None
    if shader.type == "BSDF_GLASS" and is_sharp(shader):
        return Gloss(_colour(shader, "Color"), Coat(ior=max(shader.inputs["IOR"].default_value, LEAST),
                                                    from_within=True), False, _plain(shader, "Color", "IOR"))
    if shader.type != "BSDF_PRINCIPLED":
        return None
    metallic = shader.inputs["Metallic"].default_value
    if not is_sharp(shader):
        weight, rough, index = (shader.inputs[name].default_value for name in BY_COAT)
        known = _plain(shader, *BY_COAT)
        return Gloss(np.full(3, weight), Coat(ior=max(index, LEAST)), False, known) if weight > 0.0 and rough <= (
            SHARP_ROUGHNESS) else None
    known = _plain(shader, "Metallic", "IOR", "Specular IOR Level", "Specular Tint")
    tint = _colour(shader, "Specular Tint")
    if not metallic > 0.0:
        clear = shader.inputs["Transmission Weight"].default_value >= 1.0
        return Gloss(tint, Coat(ior=index_of(shader), from_within=clear), False, known)
    # Schlick's formula is linear in the colour, and near to a dielectric's
    both = metallic * _colour(shader, "Base Color") + (1.0 - metallic) * upright(shader) * tint
    return Gloss(both, WHOLE, True, known and _plain(shader, "Base Color"))


def layers_of(shader: bpy.types.Node) -> tuple[Coat, Coat | None, bool] | None:
    """What a Principled BSDF's coat leaves to what is below, what it mirrors itself where that is sharp, and whether
    both are known all over; None where there is no coat."""
    weight, rough, index = (shader.inputs[name].default_value for name in BY_COAT)
    if not weight > 0.0:
        return None if _plain(shader, "Coat Weight") else (WHOLE, None, False)
    over = Coat(weight, ior=max(index, LEAST))
    known = _plain(shader, *BY_COAT, "Coat Tint") and min(shader.inputs["Coat Tint"].default_value[:3]) >= 1.0
    return replace(over, rest=True), over if rough <= SHARP_ROUGHNESS else None, known


def as_opaque(coat: Coat, shader: bpy.types.Node) -> tuple[Coat, bool]:
    """What a shader mirrors where it is as opaque as it is, and whether that is known all over the mirror."""
    alpha = shader.inputs.get("Alpha")
    if alpha is None:
        return coat, True
    return replace(coat, opacity=min(max(alpha.default_value, 0.0), 1.0)), not alpha.is_linked


def share_of(factor: bpy.types.NodeSocket) -> tuple[Coat, bool]:
    """What the factor of a Mix Shader is, and whether that is all over the mirror."""
    if not factor.is_linked:
        return Coat(factor.default_value), True
    source = factor.links[0].from_socket
    node = source.node
    if not any(socket.is_linked for socket in node.inputs):
        if node.type == "FRESNEL":
            return Coat(ior=max(node.inputs["IOR"].default_value, LEAST), from_within=True), True
        if node.type == "LAYER_WEIGHT":
            # as Cycles' `svm_node_layer_weight` has it
            blend = node.inputs["Blend"].default_value
            if source.name == "Fresnel":
                return Coat(ior=1.0 / max(1.0 - blend, LEAST), from_within=True), True
            blend = min(max(blend, 0.0), 1.0 - LEAST)
            power = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
            return (Coat(facing=power) if power else Coat(0.0)), True
    return Coat(factor.default_value), False


def _colour(shader: bpy.types.Node, name: str) -> np.ndarray:
    return np.array(shader.inputs[name].default_value[:3], dtype=np.float64)


def _plain(shader: bpy.types.Node, *names: str) -> bool:
    return not any(shader.inputs[name].is_linked for name in names)
