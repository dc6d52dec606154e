"""A mirror of several materials as parts of one colour each, which hide each other and throw light on."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import TriangleMesh
from ..reading import MirrorSurface
from .tint import Tint


@dataclass(frozen=True)
class MirrorPart:
    """The triangles of a mirror that have one `tint`, and the `rest` of it, None where there is none."""

    tint: Tint
    mesh: TriangleMesh
    rest: TriangleMesh | None


def parts_of(surface: MirrorSurface) -> list[MirrorPart]:
    """The parts of a mirror, in the order of its materials."""
    tints: list[Tint] = []
    number = np.zeros(len(surface.materials), dtype=np.int64)
    for index in np.unique(surface.material).tolist():
        tint = Tint.of_material(surface.materials[index])
        number[index] = next((place for place, known in enumerate(tints) if known.same(tint)), len(tints))
        if number[index] == len(tints):
            tints.append(tint)
    if len(tints) == 1:
        return [MirrorPart(tints[0], surface.mesh, None)]
    own = number[surface.material]
    return [MirrorPart(tint, _of(surface.mesh, own == place), _of(surface.mesh, own != place))
            for place, tint in enumerate(tints)]


def _of(mesh: TriangleMesh, chosen: np.ndarray) -> TriangleMesh:
    return TriangleMesh(mesh.positions, mesh.triangles[chosen], mesh.corner_normals[chosen])
