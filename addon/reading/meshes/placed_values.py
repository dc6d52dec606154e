"""Compute values at the triangles of a scene on demand. A mesh with a thousand placements is stored once, and only few
of its triangles are seen.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ....core import breathe
from .read_meshes import LocalMesh, Placed

AT_ONCE = 1 << 17  # triangles per chunk, to limit the memory of intermediate results


@dataclass(frozen=True)
class Part:
    """Triangles of a scene that belong to one mesh: indices `triangle` (n,) into the mesh, and `place` (n,) into its
    placements.
    """

    placed: Placed
    place: np.ndarray
    triangle: np.ndarray

    @property
    def mesh(self) -> LocalMesh:
        return self.placed.mesh

    @cached_property
    def turned_over(self) -> np.ndarray:
        """True (n,) for triangles whose placement mirrors the mesh. The order of their corners is reversed."""
        return self.placed.turned_over[self.place]

    @cached_property
    def corners(self) -> np.ndarray:
        """Face corners (n, 3) of the mesh, in the scene's order."""
        return np.where(self.turned_over[:, None], self.mesh.corners[self.triangle][:, [0, 2, 1]],
                        self.mesh.corners[self.triangle])


class PlacedValues:
    """Array of values at the triangles of a scene; rows are computed when they are indexed.

    Parameters
    ----------
    placed : list of Placed
    shape : tuple of int
        Shape of the values of one triangle.
    kind : numpy.dtype
    values : callable
        Function from a `Part` of n triangles to their values (n, *shape).
    """

    def __init__(self, placed: list[Placed], shape: tuple, kind: type, values: Callable[[Part], np.ndarray]) -> None:
        self._placed, self._shape, self._kind, self._values = placed, shape, kind, values
        counts = [len(item.owners) * len(item.mesh.triangles) for item in placed]
        self._starts = np.concatenate(([0], np.cumsum(counts, dtype=np.int64)))

    def __len__(self) -> int:
        return int(self._starts[-1])

    def __getitem__(self, index) -> np.ndarray:
        rows, *rest = index if isinstance(index, tuple) else (index,)
        rows = np.arange(len(self))[rows]
        found = np.empty((rows.size, *self._shape), dtype=self._kind)
        flat = rows.ravel()
        item = np.searchsorted(self._starts, flat, side="right") - 1
        order = np.argsort(item, kind="stable")
        bounds = np.searchsorted(item[order], np.arange(len(self._placed) + 1))
        for number in np.flatnonzero(np.diff(bounds)).tolist():
            own = order[bounds[number]:bounds[number + 1]]
            count = len(self._placed[number].mesh.triangles)
            for start in range(0, len(own), AT_ONCE):
                some = own[start:start + AT_ONCE]
                place, triangle = np.divmod(flat[some] - self._starts[number], count)
                found[some] = self._values(Part(self._placed[number], place, triangle))
                breathe()
        found = found.reshape(rows.shape + self._shape)
        return found[(np.arange(len(rows)), *rest)] if rest else found


def normals_of(placed: list[Placed]) -> PlacedValues:
    """Return the corner normals (m, 3, 3) float64 in world space."""
    def values(part: Part) -> np.ndarray:
        turning = part.placed.cofactors.swapaxes(1, 2)[part.place]
        normals = np.matmul(part.mesh.normals[part.triangle].astype(np.float64), turning)
        normals[part.turned_over] = normals[part.turned_over][:, [0, 2, 1]]
        return normals
    return PlacedValues(placed, (3, 3), np.float64, values)


def lines_of(placed: list[Placed]) -> tuple[PlacedValues, ...]:
    """Return four boolean arrays: sharp faces (m,), marked faces (m,), sharp sides (m, 3) and marked sides (m, 3)."""
    def sides(part: Part, kind: str) -> np.ndarray:
        flags = (part.mesh.lines.sharp_sides(part.triangle, part.placed.creases, part.place)
                 if kind == "sharp" else part.mesh.lines.marked_sides(part.triangle))
        # side k leads to the next corner: mirrored triangles have their sides in reverse order
        flags[part.turned_over] = flags[part.turned_over][:, ::-1]
        return flags

    def faces(part: Part, kind: str) -> np.ndarray:
        lines = part.mesh.lines
        return (lines.sharp_faces if kind == "sharp" else lines.marked_faces)[lines.face[part.triangle]]
    return tuple(PlacedValues(placed, shape, bool, partial(flags, kind=kind))
                 for flags, shape in ((faces, ()), (sides, (3,))) for kind in ("sharp", "marked"))


def own_places(placed: list[Placed]) -> PlacedValues:
    """Return the corners (m, 3, 3) float32 of the triangles in the space of their object."""
    return PlacedValues(placed, (3, 3), np.float32, _own)


def own_normals(placed: list[Placed]) -> PlacedValues:
    """Return the corner normals (m, 3, 3) float32 in the space of each triangle's object."""
    def values(part: Part) -> np.ndarray:
        normals = part.mesh.normals[part.triangle].astype(np.float32)
        normals[part.turned_over] = normals[part.turned_over][:, [0, 2, 1]]
        return normals
    return PlacedValues(placed, (3, 3), np.float32, values)


def generated_places(placed: list[Placed]) -> PlacedValues:
    """Return the corners (m, 3, 3) float32 in Generated coordinates, which run from 0 to 1 in the texture space box."""
    def values(part: Part) -> np.ndarray:
        middle, half = part.mesh.texture_space
        # like Cycles, use the middle where the box is flat
        share = np.divide(0.5, half, out=np.zeros_like(half), where=half != 0.0)
        return (_own(part) - middle) * share + 0.5
    return PlacedValues(placed, (3, 3), np.float32, values)


def _own(part: Part) -> np.ndarray:
    corners = part.mesh.positions[part.mesh.triangles[part.triangle]]
    corners[part.turned_over] = corners[part.turned_over][:, [0, 2, 1]]
    return corners
