"""What a mirror's material makes of light: its colour, and by which angle it becomes white."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat
from ..reading.mirror_materials import is_mirror, surface_shader

F82 = 1.0 / 7.0  # cosine of the angle at which the edge tint is given


@dataclass(frozen=True)
class Tint:
    """Reflectance by the cosine of the angle of incidence.

    Attributes
    ----------
    colour, edge : (3,) float64
        Straight on, and at 82 degrees as a part of what Schlick's formula says there.
    fresnel : bool
        Whether the angle matters.
    constant : bool
        Whether the material is one colour all over, as far as its nodes tell.
    """

    colour: np.ndarray
    edge: np.ndarray
    fresnel: bool
    constant: bool

    @classmethod
    def of(cls, mirror: bpy.types.Object) -> Tint:
        """Of the mirror's first reflecting material; white where it has none."""
        white = np.ones(3)
        material = next((slot.material for slot in mirror.material_slots if is_mirror(slot.material)), None)
        if material is None:
            return cls(white, white, False, True)
        if not compat.uses_nodes(material):
            return cls(np.array(material.diffuse_color[:3], dtype=np.float64), white, True, True)
        shader = surface_shader(material.node_tree)
        metal = shader.type in {"BSDF_PRINCIPLED", "BSDF_METALLIC"}
        edge = {"BSDF_PRINCIPLED": "Specular Tint", "BSDF_METALLIC": "Edge Tint"}.get(shader.type)
        sockets = [shader.inputs.get("Base Color") or shader.inputs.get("Color"), shader.inputs.get(edge or "")]
        colours = [white if socket is None else np.array(socket.default_value[:3], dtype=np.float64)
                   for socket in sockets]
        plain = not any(socket is not None and socket.is_linked for socket in sockets)
        return cls(*colours, metal, plain and getattr(shader, "fresnel_type", "F82") == "F82")

    def at(self, cosine: np.ndarray, bounces: np.ndarray) -> np.ndarray:
        """(m, 3, 3): what is left of red, green and blue at corners that light came to over `bounces` (m,) mirrors, the
        first of them met at `cosine` (m, 3); the later ones are taken as met straight on.

        N. Hoffman, "Fresnel Equations Considered Harmful", MAM 2019.
        """
        first = np.broadcast_to(self.colour, (*cosine.shape, 3))
        if self.fresnel:
            grazing = (1.0 - np.clip(cosine, 0.0, 1.0))[..., None]
            schlick = self.colour + (1.0 - self.colour) * (1.0 - F82)**5
            fall = schlick * (7.0 / (1.0 - F82)**6) * (1.0 - self.edge)
            first = self.colour + (1.0 - self.colour) * grazing**5 - fall * (1.0 - grazing) * grazing**6
        return np.clip(first, 0.0, 1.0) * self.colour**(bounces[:, None, None] - 1.0)
