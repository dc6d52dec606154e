"""A mirror of several materials as parts of one colour each, which hide each other and throw light on."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core import TriangleMesh
from ...reading import MirrorSurface
from .mirror_colours import MirrorColours
from .tint import Tint


@dataclass(frozen=True)
class MirrorPart:
    """A part of a mirror that has one tint.

    Attributes
    ----------
    tint : Tint
    mesh : core.TriangleMesh
    triangle : (m,) int64
        Of the object, where some of its faces may not mirror.
    others : core.TriangleMesh or None
        Other mirrors, and the rest of this one.
    colours : MirrorColours
        Of its triangles, and behind them those of the others.
    """

    tint: Tint
    mesh: TriangleMesh
    triangle: np.ndarray
    others: TriangleMesh | None
    colours: MirrorColours


def parts_of(surface: MirrorSurface, others: list[MirrorSurface]) -> list[MirrorPart]:
    """Return the parts of a mirror among others, in the order of its materials."""
    colours, count = MirrorColours.of([surface, *others]), len(surface.material)
    number, tints = _distinct(colours)
    number, parts = number[colours.tint_of[:count]], []
    for place in np.unique(number).tolist():
        own, rest = (np.flatnonzero(which) for which in (number == place, number != place))
        standing = [other.mesh for other in others] + ([_of(surface.mesh, rest)] if len(rest) else [])
        order = np.concatenate((own, np.arange(count, len(colours.tint_of)), rest))
        mesh = _of(surface.mesh, own) if len(rest) else surface.mesh
        parts.append(MirrorPart(tints[place], mesh, surface.triangle[own],
                                TriangleMesh.joined(standing) if standing else None, colours.ordered(order)))
    return parts


def _distinct(colours: MirrorColours) -> tuple[np.ndarray, list[Tint]]:
    """Return the index (k,) of each of the k tints among the distinct ones, and the distinct tints."""
    distinct: list[Tint] = []
    number = np.empty(len(colours.tints), dtype=np.int64)
    for index, tint in enumerate(colours.tints):
        number[index] = next((place for place, known in enumerate(distinct) if known.same(tint)), len(distinct))
        if number[index] == len(distinct):
            distinct.append(tint)
    return number, distinct


def _of(mesh: TriangleMesh, chosen: np.ndarray) -> TriangleMesh:
    return TriangleMesh(mesh.positions, mesh.triangles[chosen], mesh.corner_normals[chosen])
