"""Attributes for reflections of reflections: the mirrors after the first one, and their angles of incidence."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....core import ReflectionMesh, View, breathe
from ...reading.meshes import MirrorSurface
from .attribute import Attribute

NORMAL = "mirror_normal"
"""The attribute with the unit normal of the mirror at each point, of several the first one's."""
LATER_MATERIAL, LATER_COSINE = "mirror_material_{}", "mirror_cosine_{}"
"""The attributes with the material of a face's second mirror, its third and so on, as a number among the result's later
materials, -1 where it is seen by fewer; and with the cosine of the angle at which light meets it."""

ARRIVAL = "arrival_direction"
"""The attribute with the unit direction in which the eye's ray arrives at the source after the last mirror."""


def later_mirrors(result: ReflectionMesh, surfaces: Sequence[MirrorSurface],
                  view: View) -> tuple[tuple[Attribute, ...], list]:
    """Return the attributes for faces that are seen by several of the mirrors `surfaces`, and the materials that the
    attributes number. Return nothing if no face is seen by more than one mirror.
    """
    later = result.later_mirrors
    if later is None or not (later >= 0).any():
        return (), []
    materials = list(dict.fromkeys(one for surface in surfaces for one in surface.materials))
    number = np.concatenate([np.array([materials.index(one) for one in surface.materials])[surface.material]
                             for surface in surfaces])
    cosine, normal = result.cosines(view), result.mirror_normals[:, 0]
    breathe()
    attributes = [Attribute(NORMAL, "FLOAT_VECTOR", "POINT", normal.astype(np.float32)),
                  Attribute(ARRIVAL, "FLOAT_VECTOR", "POINT", _arrivals(result, view).astype(np.float32))]
    for bounce, triangle in enumerate(later.T, 2):
        material = np.where(triangle >= 0, number[np.maximum(triangle, 0)], -1)
        attributes += [
            Attribute(LATER_MATERIAL.format(bounce), "INT", "FACE", material.astype(np.int32)),
            Attribute(LATER_COSINE.format(bounce), "FLOAT", "POINT", cosine[:, bounce - 1].astype(np.float32))]
    return tuple(attributes), materials


def _arrivals(result: ReflectionMesh, view: View) -> np.ndarray:
    """Return the unit directions (n, 3) of the eye's rays after the last mirror of each vertex."""
    ahead = view.directions(result.mirror_position)
    ahead = ahead / np.linalg.norm(ahead, axis=1)[:, None]
    # the normal is zero for mirrors that do not show a vertex, and reflects nothing
    for normal in np.moveaxis(result.mirror_normals, 1, 0):
        ahead = ahead - 2.0 * np.einsum("ni,ni->n", ahead, normal)[:, None] * normal
    return ahead
