"""What a mirror's material makes of light: its colour, and by which angle it becomes white."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ... import compat
from ...reading.materials import MIRRORS, is_mirror, is_sharp, surface_shader
from .coat import WHOLE, Coat, as_opaque, gloss_of, share_of

F82 = 1.0 / 7.0  # cosine of the angle at which the edge tint is given


@dataclass(frozen=True)
class Texture:
    """What is plugged into a socket of a material's node, by their names: nodes may be gone at another moment."""

    material: bpy.types.Material
    node: str
    socket: str

    @property
    def plugged_in(self) -> bpy.types.NodeSocket | None:
        """It; None where nothing is any more."""
        node = self.material.node_tree.nodes.get(self.node)
        socket = None if node is None else next((one for one in node.inputs if one.identifier == self.socket), None)
        return socket.links[0].from_socket if socket is not None and socket.is_linked else None


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
    coat : Coat
        How much of the light the mirror sends back where it is mixed with something else.
    texture : Texture, optional
        Where the colour alone changes over the material, what tells it.
    """

    colour: np.ndarray
    edge: np.ndarray
    fresnel: bool
    constant: bool
    coat: Coat = WHOLE
    texture: Texture | None = None

    @classmethod
    def of(cls, mirror: bpy.types.Object) -> Tint:
        """Of the mirror's first reflecting material; white where it has none."""
        materials = [slot.material for slot in mirror.material_slots if slot.material is not None]
        reflecting = (one for one in materials if is_mirror(one) or (
            compat.uses_nodes(one) and (_coated(one) or gloss_of(surface_shader(one.node_tree)))))
        return cls.of_material(next(reflecting, None))

    @classmethod
    def of_material(cls, material: bpy.types.Material | None) -> Tint:
        """Of a mirror's material; white where it mirrors nothing, as far as its nodes tell."""
        white = np.ones(3)
        if material is None:
            return cls(white, white, False, True)
        if not compat.uses_nodes(material):
            return (cls(np.array(material.diffuse_color[:3], dtype=np.float64), white, True, True)
                    if is_mirror(material) else cls(white, white, False, True))
        shader, coat, known = (surface_shader(material.node_tree), WHOLE, True) if is_mirror(material) else (
            _coated(material) or (None, WHOLE, True))
        if shader is None:
            lacquer = surface_shader(material.node_tree)
            gloss = gloss_of(lacquer)
            if gloss is None:
                return cls(white, white, False, True)
            coat, known = as_opaque(gloss.coat, lacquer)
            return cls(gloss.colour, white, gloss.metal, gloss.known and known, coat)
        metal = shader.type in {"BSDF_PRINCIPLED", "BSDF_METALLIC"}
        edge = {"BSDF_PRINCIPLED": "Specular Tint", "BSDF_METALLIC": "Edge Tint"}.get(shader.type)
        sockets = [shader.inputs.get("Base Color") or shader.inputs.get("Color"), shader.inputs.get(edge or "")]
        colours = [white if socket is None else np.array(socket.default_value[:3], dtype=np.float64)
                   for socket in sockets]
        linked = [socket is not None and socket.is_linked for socket in sockets]
        coat, opaque = as_opaque(coat, shader)
        known = known and opaque and not linked[1] and getattr(shader, "fresnel_type", "F82") == "F82"
        texture = Texture(material, shader.name, sockets[0].identifier) if known and linked[0] else None
        return cls(*colours, metal, known and not linked[0], coat, texture)

    def same(self, other: Tint) -> bool:
        """Whether both make the same of light."""
        return (np.array_equal(self.colour, other.colour) and np.array_equal(self.edge, other.edge)
                and (self.fresnel, self.constant, self.coat, self.texture)
                == (other.fresnel, other.constant, other.coat, other.texture))

    def at(self, cosine: np.ndarray) -> np.ndarray:
        """What is left of red, green and blue, (..., 3), where light meets the mirror at `cosine` (...), negative at
        its back.

        N. Hoffman, "Fresnel Equations Considered Harmful", MAM 2019.
        """
        left = np.broadcast_to(self.colour, (*cosine.shape, 3))
        if self.fresnel:
            grazing = (1.0 - np.clip(np.abs(cosine), 0.0, 1.0))[..., None]
            schlick = self.colour + (1.0 - self.colour) * (1.0 - F82)**5
            fall = schlick * (7.0 / (1.0 - F82)**6) * (1.0 - self.edge)
            left = self.colour + (1.0 - self.colour) * grazing**5 - fall * (1.0 - grazing) * grazing**6
        return self.coat.at(cosine)[..., None] * np.clip(left, 0.0, 1.0)

    def by_colour(self, cosine: np.ndarray) -> np.ndarray:
        """By how much what is left, (..., 3), grows with the colour, of which it is linear."""
        white, black = (replace(self, colour=np.full(3, value)).at(cosine) for value in (1.0, 0.0))
        return white - black


def _coated(material: bpy.types.Material) -> tuple[bpy.types.Node, Coat, bool] | None:
    """The mirror that a material mixes with something else, its share, and whether that is known; None where it mixes
    none."""
    mixed = surface_shader(material.node_tree)
    if mixed is None or mixed.type != "MIX_SHADER":
        return None
    factor, *both = mixed.inputs
    for place, socket in enumerate(both):
        shader = socket.links[0].from_node if socket.is_linked else None
        if shader is not None and shader.type in MIRRORS and is_sharp(shader):
            share, known = share_of(factor)
            return shader, replace(share, rest=place == 0), known
    return None
