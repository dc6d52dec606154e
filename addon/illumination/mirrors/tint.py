"""Compute the reflectance of a mirror's material: its colour, and its rise to white at grazing angles."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ... import compat
from ...reading.materials import is_mirror, shown_output
from .coat import WHOLE, Coat, as_opaque, gloss_of, layers_of
from .lobes import Lobe, lobes_of

F82 = 1.0 / 7.0  # cosine of the angle at which the edge tint is given


@dataclass(frozen=True)
class Texture:
    """The link into a socket of a material's node, stored by names, since nodes may be removed at any time."""

    material: bpy.types.Material
    node: str
    socket: str

    @property
    def plugged_in(self) -> bpy.types.NodeSocket | None:
        """The linked output socket; None if nothing is linked any more."""
        node = self.material.node_tree.nodes.get(self.node)
        socket = None if node is None else next((one for one in node.inputs if one.identifier == self.socket), None)
        return socket.links[0].from_socket if socket is not None and socket.is_linked else None


@dataclass(frozen=True)
class Tint:
    """Reflectance by the cosine of the angle of incidence.

    Attributes
    ----------
    colour, edge : (3,) float64
        Reflectance at normal incidence, and at 82 degrees relative to Schlick's formula.
    fresnel : bool
        True if the reflectance depends on the angle.
    constant : bool
        True if the material has one colour all over, as far as its nodes are known.
    coat : Coat
        Share of the mirror in a mix with other shaders.
    conductor : tuple of two (3,) float64, optional
        Refractive index and extinction coefficient of a metal that is defined by these.
    texture : Texture, optional
        Source of the colour, if only the colour varies.
    more : tuple of Tint
        Further reflecting shaders of the material, which add up.
    """

    colour: np.ndarray
    edge: np.ndarray
    fresnel: bool
    constant: bool
    coat: Coat = WHOLE
    conductor: tuple[np.ndarray, np.ndarray] | None = None
    texture: Texture | None = None
    more: tuple[Tint, ...] = ()

    @classmethod
    def of(cls, mirror: bpy.types.Object) -> Tint:
        """Return the tint of the mirror's first reflecting material; white if it has none."""
        materials = [slot.material for slot in mirror.material_slots if slot.material is not None]
        return cls.of_material(next((one for one in materials if is_mirror(one) or has_mirrors(one)), None))

    @classmethod
    def of_material(cls, material: bpy.types.Material | None) -> Tint:
        """Return the tint of a mirror's material; white if it reflects nothing as far as its nodes are known."""
        white = np.ones(3)
        if material is not None and not compat.uses_nodes(material) and is_mirror(material):
            return cls(np.array(material.diffuse_color[:3], dtype=np.float64), white, True, True)
        # rough metal that is a mirror all the same has its colour
        found = _tints_of(material) or _tints_of(material, rough=True)
        if len(found) < 2:
            return found[0] if found else cls(white, white, False, True)
        # the texture of one shader is supported if all others have one colour
        first = next((one for one in found if not one.constant), found[0])
        more = tuple(one for one in found if one is not first)
        plain = all(one.constant for one in more)
        return replace(first, constant=first.constant and plain, more=more, texture=first.texture if plain else None)

    def same(self, other: Tint) -> bool:
        """Return True if both have the same reflectance."""
        return (np.array_equal(self.colour, other.colour) and np.array_equal(self.edge, other.edge)
                and np.array_equal(np.ravel(self.conductor), np.ravel(other.conductor))
                and (self.fresnel, self.constant, self.coat, self.texture)
                == (other.fresnel, other.constant, other.coat, other.texture)
                and len(self.more) == len(other.more) and all(map(Tint.same, self.more, other.more)))

    def at(self, cosine: np.ndarray) -> np.ndarray:
        """Return the reflectance (..., 3) at the cosines `cosine` (...), negative at back faces.

        N. Hoffman, "Fresnel Equations Considered Harmful", MAM 2019; of conductors M. Pharr, G. Humphreys, "Physically
        Based Rendering", 2nd edition, section 8.2.1.
        """
        left = np.broadcast_to(self.colour, (*cosine.shape, 3))
        if self.conductor is not None:
            (index, extinction), straight = self.conductor, np.clip(np.abs(cosine), 0.0, 1.0)[..., None]
            size, bend = index**2 + extinction**2, 2.0 * index * straight
            left = 0.5 * sum((one - bend) / (one + bend) for one in (size * straight**2 + 1.0, size + straight**2))
        elif self.fresnel:
            grazing = (1.0 - np.clip(np.abs(cosine), 0.0, 1.0))[..., None]
            schlick = self.colour + (1.0 - self.colour) * (1.0 - F82)**5
            fall = schlick * (7.0 / (1.0 - F82)**6) * (1.0 - self.edge)
            left = self.colour + (1.0 - self.colour) * grazing**5 - fall * (1.0 - grazing) * grazing**6
        own = self.coat.at(cosine)[..., None] * np.clip(left, 0.0, 1.0)
        return sum((one.at(cosine) for one in self.more), own)

    def by_colour(self, cosine: np.ndarray) -> np.ndarray:
        """Return the derivative (..., 3) of the reflectance by the colour, in which it is linear."""
        white, black = (replace(self, colour=np.full(3, value), more=()).at(cosine) for value in (1.0, 0.0))
        return white - black


def has_mirrors(material: bpy.types.Material | None) -> bool:
    """Return True if any shader of a material reflects sharply."""
    return bool(_tints_of(material))


def _tints_of(material: bpy.types.Material | None, rough: bool = False) -> list[Tint]:
    """Return the shaders of a material that mirror sharply, and those of `rough` metal."""
    output = shown_output(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    lobes = [] if output is None else lobes_of(output.inputs["Surface"])
    return [tint for lobe in lobes for tint in _tints_of_lobe(material, lobe, rough)]


def _tints_of_lobe(material: bpy.types.Material, lobe: Lobe, rough: bool) -> list[Tint]:
    """Return the tints of a shader and of its coat."""
    shader, white = lobe.shader, np.ones(3)
    layers = layers_of(shader) if shader.type == "BSDF_PRINCIPLED" and lobe.is_sharp else None
    below, over, known = layers or (WHOLE, None, True)
    below, over = (None if one is None else replace(one, within=lobe.share) for one in (below, over))
    below, opaque = as_opaque(below, shader)
    known = lobe.known and known and opaque
    coats = [] if over is None else [Tint(white, white, False, known, as_opaque(over, shader)[0])]
    if lobe.is_metal and (rough or lobe.is_sharp):
        return [_of_metal(material, lobe, below, known), *coats]
    gloss = gloss_of(shader)
    if gloss is None:
        return coats
    return [Tint(gloss.colour, white, gloss.metal, gloss.known and known, replace(gloss.coat, within=below)), *coats]


def _of_metal(material: bpy.types.Material, lobe: Lobe, coat: Coat, known: bool) -> Tint:
    """Return the tint of a Glossy, a Metallic or a metallic Principled BSDF."""
    shader, white = lobe.shader, np.ones(3)
    if getattr(shader, "fresnel_type", "F82") == "PHYSICAL_CONDUCTOR":
        (index, plain), (extinction, plain_too) = lobe.told("IOR"), lobe.told("Extinction")
        return Tint(white, white, True, known and plain and plain_too, coat, (index, extinction))
    metal = shader.type in {"BSDF_PRINCIPLED", "BSDF_METALLIC"}
    base = "Base Color" if "Base Color" in shader.inputs else "Color"
    edge = {"BSDF_PRINCIPLED": "Specular Tint", "BSDF_METALLIC": "Edge Tint"}.get(shader.type)
    colour, plain = lobe.told(base)
    tint, plain_edge = (white, True) if edge is None else lobe.told(edge)
    known = known and plain_edge
    # nodes within groups are not found by their names
    texture = Texture(material, shader.name, shader.inputs[base].identifier) if (
        known and not plain and not lobe.groups) else None
    return Tint(colour, tint, metal, known and plain, coat, texture=texture)
