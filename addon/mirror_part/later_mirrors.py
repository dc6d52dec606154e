"""Attenuation of light by further mirrors, if the eye sees it after more than one reflection."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat
from ..illumination import MirrorColours, Tint
from ..reading import corner_vertices, numbers
from ..reading.materials import glows, is_mirror, is_opaque, surface_shaders
from ..writing import LATER_COSINE, LATER_MATERIAL
from ..writing.nodes.shader_builder import ShaderBuilder

LATER_TINT, LATER_UNKNOWN = "later_tint", "later_unknown"
"""The attributes with what all mirrors but the first leave of the light, in red, green and blue, and with 1 on faces of
which that is not all: such mirrors have a ground that is seen as well, or textures."""
LATER = {LATER_TINT, LATER_UNKNOWN}
ANGLES = np.linspace(0.0, 1.0, 9)  # cosines at which a perfect mirror is told from others


@dataclass(frozen=True)
class LaterMirrors:
    """The mirrors that a mirror shows mirrors in.

    Attributes
    ----------
    takes : bool
        Whether any takes some of the light.
    unknown : bool
        Whether of any it is not known what else it shows.
    """

    takes: bool = False
    unknown: bool = False

    @classmethod
    def of(cls, result: bpy.types.Object) -> LaterMirrors:
        """Return the later mirrors of a result with faces. Both flags are False if it has none."""
        if LATER_MATERIAL.format(2) not in result.data.attributes:
            return cls()
        return cls(any((tint.at(ANGLES) < 1.0).any() for tint in _tints(result)), not all(_is_whole(result)))

    def leave(self, build: ShaderBuilder, colour):
        """Return `colour`, a socket or a colour, times the tint of the later mirrors."""
        if not self.takes:
            return colour
        left = build.add("ShaderNodeAttribute", attribute_name=LATER_TINT).outputs["Vector"]
        return build.blended("MULTIPLY", 1.0, colour, left)

    def behind(self, build: ShaderBuilder, shown: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """A surface that is clear where the mirror itself, seen behind it, knows better."""
        if not self.unknown:
            return shown
        clear = build.add("ShaderNodeBsdfTransparent").outputs[0]
        return build.mixed(build.add("ShaderNodeAttribute", attribute_name=LATER_UNKNOWN).outputs["Fac"], shown, clear)


def write_later_tints(result: bpy.types.Object, mesh: bpy.types.Mesh) -> None:
    """Write what later mirrors leave of the light at each corner of a result's `mesh`, and on each face whether that is
    all, by their materials as these are now."""
    left, unknown = np.ones((len(mesh.polygons), 3, 3)), np.zeros(len(mesh.polygons), dtype=bool)
    if LATER_MATERIAL.format(2) in mesh.attributes:
        bounces, tints = range(2, max(int(numbers(mesh, "bounces").max(initial=1)), 2) + 1), _tints(result)
        met, cosine = (np.stack([numbers(mesh, name.format(bounce)) for bounce in bounces], axis=1)
                       for name in (LATER_MATERIAL, LATER_COSINE))
        later, corners = np.flatnonzero(met[:, 0] >= 0), corner_vertices(mesh)
        left[later] = MirrorColours(tints, np.arange(len(tints))).left(
            met[later], cosine[corners[later]].astype(np.float64))
        # those that are seen by no more have the last number
        whole = _is_whole(result)
        unknown = ~np.array(whole + [True])[met].all(axis=1)
        # faces of the world lie behind those, and show it by any of the mirrors
        unknown |= (numbers(mesh, "source_object") < 0) & (not all(whole))
    _write(mesh, LATER_TINT, ("FLOAT_VECTOR", "CORNER", "vector"), left)
    _write(mesh, LATER_UNKNOWN, ("FLOAT", "FACE", "value"), unknown)


def _write(mesh: bpy.types.Mesh, name: str, kind: tuple[str, str, str], values: np.ndarray) -> None:
    written = mesh.attributes.get(name) or mesh.attributes.new(name, *kind[:2])
    written.data.foreach_set(kind[2], values.astype(np.float32).reshape(-1))


def _tints(result: bpy.types.Object) -> list[Tint]:
    return [Tint.of_material(entry.material) for entry in result.reflection_mesh.later_materials]


def _is_whole(result: bpy.types.Object) -> list[bool]:
    """Return a flag for each material of the later mirrors: True if its tint alone describes its appearance.

    That holds for mirrors of one colour that are opaque, do not emit and have no coat.
    """
    materials = [entry.material for entry in result.reflection_mesh.later_materials]
    return [material is None or is_mirror(material) and is_opaque(material) and not glows(material)
            and not _has_coat(material) and Tint.of_material(material).constant for material in materials]


def _has_coat(material: bpy.types.Material) -> bool:
    weights = [shader.inputs["Coat Weight"] for shader in (
        surface_shaders(material.node_tree) if compat.uses_nodes(material) else ()) if "Coat Weight" in shader.inputs]
    return any(weight.is_linked or weight.default_value > 0.0 for weight in weights)
