"""Compute the reflectance by angle of mirrors that also transmit light, such as glass and lacquer."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...reading.materials import SHARP_ROUGHNESS, index_of, is_sharp, upright

LEAST = 1e-5  # refractive index
BY_COAT = ("Coat Weight", "Coat Roughness", "Coat IOR")


@dataclass(frozen=True)
class Coat:
    """The reflectance of the mirror in a material, by angle.

    Attributes
    ----------
    factor : float
    ior : float
        If not 0, the share is multiplied by the reflectance of a dielectric with this refractive index.
    from_within : bool
        Use the inverse index at back faces, which light meets from inside.
    facing : float
        If not 0, the share is `1 - cos(theta) ** facing`.
    rest : bool
        The share is the complement, 1 minus the share so far.
    opacity : float
        Opacity of the material, a factor of everything.
    within : Coat, optional
        Share of all this in an outer mix.
    """

    factor: float = 1.0
    ior: float = 0.0
    from_within: bool = False
    facing: float = 0.0
    rest: bool = False
    opacity: float = 1.0
    within: Coat | None = None

    def at(self, cosine: np.ndarray) -> np.ndarray:
        """Return the share by the cosine of the angle of incidence, negative at back faces."""
        share, c = np.full(cosine.shape, self.factor), np.clip(np.abs(cosine), 0.0, 1.0)
        if self.ior:
            inside = (cosine < 0.0) & self.from_within
            share = self.factor * _reflectance(np.where(inside, 1.0 / self.ior, self.ior), c)
        elif self.facing:
            share = 1.0 - c**self.facing
        share = self.opacity * (1.0 - share if self.rest else share)
        return share if self.within is None else share * self.within.at(cosine)


def _reflectance(ior: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the reflectance of a dielectric at the cosine `c` of the angle of incidence; 1 beyond the critical angle.

    Same formula as `fresnel_dielectric_cos` of Cycles' kernel.
    """
    g = np.sqrt(np.maximum(ior**2 - 1.0 + c**2, 0.0))
    a, b = (g - c) / np.maximum(g + c, 1e-300), (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return 0.5 * a**2 * (1.0 + b**2)


WHOLE = Coat()


@dataclass(frozen=True)
class Gloss:
    """The reflection of a non-metallic shader: its `colour` (3,), its share by angle (`coat`), or, if `metal` (partly
    metallic), the metal's Fresnel; and `known`, True if these hold all over the surface.
    """

    colour: np.ndarray
    coat: Coat
    metal: bool
    known: bool


def gloss_of(shader: bpy.types.Node | None) -> Gloss | None:
    """Return the reflection of glass, water, lacquer or partly metallic shaders; None if a shader does not reflect
    sharply.
    """
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
    """Return what a Principled BSDF's coat transmits to the layers below, what it reflects itself (None if not sharp),
    and True if both are fully known. Return None if there is no coat.
    """
    weight, rough, index = (shader.inputs[name].default_value for name in BY_COAT)
    if not weight > 0.0:
        return None if _plain(shader, "Coat Weight") else (WHOLE, None, False)
    over = Coat(weight, ior=max(index, LEAST))
    known = _plain(shader, *BY_COAT, "Coat Tint") and min(shader.inputs["Coat Tint"].default_value[:3]) >= 1.0
    return replace(over, rest=True), over if rough <= SHARP_ROUGHNESS else None, known


def as_opaque(coat: Coat, shader: bpy.types.Node) -> tuple[Coat, bool]:
    """Return the share of a shader times its opacity, and True if that is constant over the mirror."""
    alpha = shader.inputs.get("Alpha")
    if alpha is None:
        return coat, True
    return replace(coat, opacity=min(max(alpha.default_value, 0.0), 1.0)), not alpha.is_linked


def share_of(factor: bpy.types.NodeSocket) -> tuple[Coat, bool]:
    """Return the share of a Mix Shader's factor, and True if it is constant over the mirror."""
    if not factor.is_linked:
        return Coat(factor.default_value), True
    source = factor.links[0].from_socket
    node = source.node
    if not any(socket.is_linked for socket in node.inputs):
        if node.type == "FRESNEL":
            return Coat(ior=max(node.inputs["IOR"].default_value, LEAST), from_within=True), True
        if node.type == "LAYER_WEIGHT":
            # same formulas as `svm_node_layer_weight` of Cycles
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
