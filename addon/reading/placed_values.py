"""Values at the triangles of a scene, worked out where they are asked for: a mesh that stands in a thousand places is
kept once, and few of its triangles are seen."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from .read_meshes import LocalMesh, Placed


@dataclass(frozen=True)
class Part:
    """Triangles of a scene that are of one mesh: its `triangle` (n,), and the number (n,) of the place of each."""

    placed: Placed
    place: np.ndarray
    triangle: np.ndarray

    @property
    def mesh(self) -> LocalMesh:
        return self.placed.mesh

    @cached_property
    def turned_over(self) -> np.ndarray:
        """Which of the triangles (n,) are turned inside out where they stand; their corners are in another order."""
        return turned_over(self.placed.matrices)[self.place]

    @cached_property
    def corners(self) -> np.ndarray:
        """Face corners (n, 3) of the mesh, in the scene's order."""
        return np.where(self.turned_over[:, None], self.mesh.corners[self.triangle][:, [0, 2, 1]],
                        self.mesh.corners[self.triangle])


class PlacedValues:
    """An array of values at the triangles of a scene, of which rows are worked out by indexing.

    Parameters
    ----------
    placed : list of Placed
    shape : tuple of int
        Of one triangle's values.
    kind : numpy.dtype
    values : callable
        From a `Part` of n triangles to their values (n, *shape).
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
            place, triangle = np.divmod(flat[own] - self._starts[number], len(self._placed[number].mesh.triangles))
            found[own] = self._values(Part(self._placed[number], place, triangle))
        found = found.reshape(rows.shape + self._shape)
        return found[(np.arange(len(rows)), *rest)] if rest else found


def turned_over(matrices: np.ndarray) -> np.ndarray:
    """Which transforms (k,) turn space inside out."""
    return np.linalg.det(matrices[:, :3, :3]) < 0.0


def cofactors(matrices: np.ndarray) -> np.ndarray:
    """What takes normals to world space, (k, 3, 3): also where a scale is zero."""
    linear = matrices[:, :3, :3]
    across = np.stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)], axis=1)
    return across * np.where(turned_over(matrices), -1.0, 1.0)[:, None, None]


def normals_of(placed: list[Placed]) -> PlacedValues:
    """Corner normals (m, 3, 3) float64 in world space."""
    def values(part: Part) -> np.ndarray:
        turning = cofactors(part.placed.matrices).swapaxes(1, 2)[part.place]
        normals = np.matmul(part.mesh.normals[part.triangle].astype(np.float64), turning)
        normals[part.turned_over] = normals[part.turned_over][:, [0, 2, 1]]
        return normals
    return PlacedValues(placed, (3, 3), np.float64, values)


def lines_of(placed: list[Placed]) -> tuple[PlacedValues, ...]:
    """Faces that are sharp (m,), those that are marked, sides that are sharp (m, 3), those that are marked."""
    def sides(part: Part, kind: str) -> np.ndarray:
        flags = (part.mesh.lines.sharp_sides(part.triangle, cofactors(part.placed.matrices), part.place)
                 if kind == "sharp" else part.mesh.lines.marked_sides(part.triangle))
        # side k leads to the next corner: of a triangle turned over, from the last corner to the one before
        flags[part.turned_over] = flags[part.turned_over][:, ::-1]
        return flags

    def faces(part: Part, kind: str) -> np.ndarray:
        lines = part.mesh.lines
        return (lines.sharp_faces if kind == "sharp" else lines.marked_faces)[lines.face[part.triangle]]
    return tuple(PlacedValues(placed, shape, bool, partial(flags, kind=kind))
                 for flags, shape in ((faces, ()), (sides, (3,))) for kind in ("sharp", "marked"))
