"""The part of a reflection that is made backwards: one ray from the eye per pixel, and faces between the hit points."""
from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from ..cameras import MirrorSurface
from ..culling import SceneAndMirrors
from ..geometry import TriangleMesh, dot, norm, unit
from ..support import FACE_SHARE, LEFT, Settings, breathe
from ..trees import SceneTree, first_of_many
from ..views import View
from .cell_faces import CellFaces, faces_of_cells
from .cells import Labels, cells_of
from .decision import MOST_POINTS, may_have_small_parts, small_parts
from .lattice import ASIDE, Lattice, lattice_step
from .mirror_places import MirrorPlaces
from .outlines import NEAREST, Sides, between, crossings, halved, joined
from .paths import NOTHING, Paths, PathTracer

LOOKED = 0.02   # share of the rays to outlines that may hit one more mirror and end there, if the depth is automatic
STRAIGHT = 0.1  # pixels: largest distance of an outline from the straight line that replaces it


class BackwardPart:
    """Samples of a mirror, and the faces between them.

    Parameters
    ----------
    view : View
    mirror : TriangleMesh
    met : SceneAndMirrors
    settings : Settings

    Attributes
    ----------
    chosen : (m,) bool
        True for mirror triangles that are sampled; the others only occlude them.
    rays : int
        Number of rays traced.
    samples : int
        Number of samples. They are the first vertices of the faces.
    counts : dict
        Number of sampled pixels of the mirror, and of those that still see a mirror after the last bounce; the depth.
    """

    def __init__(self, view: View, mirror: TriangleMesh, met: SceneAndMirrors, settings: Settings) -> None:
        self.view, self.mirror, self.met, self.depth = view, mirror, met, settings.bounces
        self.enough = 0.0 if settings.depth else LEFT
        self.tolerance = FACE_SHARE * settings.tolerance
        self.rays = 0
        self.counts: dict[str, int] = {}
        self.samples = 0
        self.chosen = np.zeros(len(mirror.triangles), dtype=bool)
        self.lattice = Lattice.around(view, mirror.positions[mirror.used], lattice_step(settings))
        mirrors = len(met.mirrors.triangles) if self.depth > 1 else 0
        if not may_have_small_parts(mirror, self.lattice, mirrors):
            return
        whole, self.lattice = self.lattice, self.lattice.coarser(MOST_POINTS)
        self.drawn = self._drawn()
        chosen = small_parts(mirror, self.lattice, self.drawn[0], self._sees_mirrors, mirrors)
        if not chosen[self.drawn[0][self.drawn[0] >= 0]].any():
            return
        self.chosen = chosen
        if whole is not self.lattice:
            self.lattice = whole.coarser(max(settings.maximum_faces, MOST_POINTS))
            self.drawn = self._drawn()

    def __bool__(self) -> bool:
        return bool(self.chosen.any())

    def _drawn(self) -> tuple[np.ndarray, np.ndarray]:
        positions = np.zeros_like(self.mirror.positions)
        positions[self.mirror.used] = self.mirror.positions[self.mirror.used]
        return self.lattice.drawn(positions, self.mirror.triangles)

    def _places(self, number: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the mirror triangles (n,) that lattice points `number` (n,) see, and the places (3, n) on them."""
        face, weights = (part[..., number] for part in self.drawn)
        corners = self.mirror.positions[self.mirror.triangles[face]]
        return face, np.einsum("kn,nki->in", weights, corners)

    def _sees_mirrors(self, number: np.ndarray) -> np.ndarray:
        return self.tracer.traced(*self._places(number), 1)[1]

    @cached_property
    def tracer(self) -> PathTracer:
        surface = self.met.surface if self.mirror is self.met.mirrors else MirrorSurface(self.mirror)
        used = self.mirror.positions[self.mirror.used]
        return PathTracer(self.view, surface, self.met, float(np.ptp(used, axis=0).max()))

    @cached_property
    def tree(self) -> SceneTree:
        return self.met.mirror_tree if self.mirror is self.met.mirrors else SceneTree.of_ordered(self.mirror)

    def faces(self) -> tuple[Paths, np.ndarray, CellFaces]:
        """Compute the faces: return their vertices as paths, the vertices' pixel positions (n, 2), and the faces."""
        lattice = self.lattice
        width, height = lattice.size
        number = np.flatnonzero(self.drawn[0] >= 0)
        number = number[self.chosen[self.drawn[0][number]]]
        paths, left = self._traced(*self._places(number))
        self.samples, pixels = len(number), len(number) * lattice.step**2
        self.counts = {"mirror_pixels": round(pixels), "left_pixels": round(int(left.sum()) * lattice.step**2),
                       "depth": int(paths.bounces.max(initial=1))}
        spots = lattice.spots(number)
        at = np.full(width * height, -1)
        at[number] = np.arange(len(number))
        at = at.reshape(height, width)
        key = np.where(at >= 0, self._keys(paths)[at], NOTHING)
        node = np.where(key >= 0, at, -1)
        sides = [self._sides(at, key, axis) for axis in (1, 0)]
        every, nodes, shares, borders = paths, [], [], [np.zeros(len(spots), dtype=bool)]
        for axis, (where, side) in zip((1, 0), sides):
            share, first, second = self._on_outlines(side, paths, spots, key, where, axis)
            jumps = self._jumps(side, paths, share, first, second)
            both = np.full((2, height, width), -1)
            for which, ends in enumerate((first, second)):
                seen = ends[0]
                both[which][tuple(part[seen] for part in where)] = len(spots) + np.arange(len(seen))
                every, spots = joined([every, ends[1]]), np.concatenate((spots, ends[2]))
                borders.append(jumps[seen])
            nodes.append(both)
            shares.append(np.full((height, width), np.inf))
            shares[-1][where] = share
        labels = Labels(key, node, nodes[0], nodes[1], shares[0], shares[1], self._rough(paths, at, key))
        cells = faces_of_cells(labels, cells_of(labels, self.lattice.step, STRAIGHT), len(spots))
        middle, spot = self._middles(every, spots, cells, np.concatenate(borders))
        self.counts["rays"] = self.rays
        every, spots = joined([every, middle]), np.concatenate((spots, spot)) + ASIDE
        places = MirrorPlaces(self.view, self.mirror, self.tracer.surface, self.tree, self.chosen)
        return places.of(self._moved(every, spots), spots), spots, cells

    def _traced(self, face: np.ndarray, place: np.ndarray, enough: float = 0.0) -> tuple[Paths, np.ndarray]:
        paths, left = self.tracer.traced(face, place, self.depth, max(enough, self.enough) if self.enough else 0.0)
        self.rays += len(face)
        covered = self.tracer.covered(place)
        return replace(paths, source=np.where(covered, NOTHING, paths.source)), left

    def _keys(self, paths: Paths) -> np.ndarray:
        """Return a key (n,) for each path that combines its source triangle and its number of bounces."""
        return np.where(paths.source >= 0, paths.source * (self.depth + 1) + paths.bounces, NOTHING)

    def source(self, key: np.ndarray) -> np.ndarray:
        return key // (self.depth + 1)

    def _sides(self, at: np.ndarray, key: np.ndarray, axis: int) -> tuple[tuple, Sides]:
        """Find lattice sides along an axis whose ends have different keys.

        Return the rows and columns (m,) of their starts, and the sides.
        """
        height, width = key.shape
        end = (slice(1, None), slice(None)) if axis == 0 else (slice(None), slice(1, None))
        start = (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))
        where = np.nonzero(key[start] != key[end])
        step = np.array((1, 0)) if axis == 0 else np.array((0, 1))

        def sample(times: int) -> np.ndarray:
            row, column = where[0] + times * step[0], where[1] + times * step[1]
            inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            return np.where(inside, at[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)], -1)
        return where, Sides(sample(0), sample(1), sample(-1), sample(2))

    def _on_outlines(self, side: Sides, paths: Paths, spots: np.ndarray, key: np.ndarray, where: tuple, axis: int):
        """Place vertices where outlines cross lattice sides.

        Returns
        -------
        share : (m,) float64
            Place of the outline along each side, from 0 to 1.
        first, second : tuple
            For what is seen at the start, and at the end, of the sides: the sides (k,) with a vertex, the vertices as
            paths, and their pixel positions (k, 2).
        """
        keys = self._keys(paths)
        share, doubtful = crossings(side, paths, keys, self.met)
        step = self.lattice.step * (np.array((0.0, 1.0)) if axis == 0 else np.array((1.0, 0.0)))
        width = key.shape[1]
        first_spot = self.lattice.spots(where[0] * width + where[1])
        own = [np.where(end >= 0, keys[end], NOTHING) for end in (side.start, side.end)]
        chosen = np.flatnonzero(doubtful)

        def look(some, way):
            return self._looked(first_spot[chosen[some]] + way[:, None] * step)
        start, end = (paths.select(np.maximum(number[chosen], 0)) for number in (side.start, side.end))
        share[chosen], found_first, found_second = halved(start, end, (own[0][chosen], own[1][chosen]), look)
        spot = first_spot + share[:, None] * step
        sure = np.flatnonzero(~doubtful)
        results = []
        for seen, one, other, way, found in ((own[0], side.start, side.end, share, found_first),
                                             (own[1], side.end, side.start, 1.0 - share, found_second)):
            known, asked = sure[seen[sure] >= 0], np.flatnonzero(seen[chosen] >= 0)
            parts = [between(paths.select(one[known]), paths.select(other[known]), way[known], self.met),
                     self._moved(found.select(asked), spot[chosen[asked]])]
            number = np.concatenate((known, chosen[asked]))
            results.append((number, joined(parts), spot[number]))
        return share, *results

    def _looked(self, spots: np.ndarray) -> tuple[np.ndarray, Paths, np.ndarray]:
        """Trace rays at `spots` (n, 2) in pixels; return the indices (k,) of spots that see the sampled mirror, their
        paths, and the paths' keys (k,).
        """
        origin, ray = (given.T for given in self.view.rays(spots))
        face, distance = first_of_many(self.tree, origin, ray)
        seen = np.flatnonzero((face >= 0) & self.chosen[face])
        paths, _ = self._traced(face[seen], origin[:, seen] + distance[seen] * ray[:, seen], LOOKED)
        return seen, paths, self._keys(paths)

    def _moved(self, paths: Paths, spots: np.ndarray) -> Paths:
        """Return the paths moved to other `spots` (n, 2) in pixels; their depth from the eye stays the same."""
        origin, ray = (given.T for given in self.view.rays(spots))
        forward = self.view.forward[:, None]
        depth = dot(paths.place - origin, forward) / dot(ray, forward)
        place = origin + depth * ray
        return replace(paths, place=place, origin=np.where(paths.bounces == 1, place, paths.origin))

    @staticmethod
    def _jumps(side: Sides, paths: Paths, share: np.ndarray, first: tuple, second: tuple) -> np.ndarray:
        """Return True (m,) for outlines at which the visible surface ends; inside it one triangle follows another."""
        apart, motion = np.full((2, 3, len(share)), np.nan), np.zeros(len(share))
        for which, (number, seen, _) in enumerate((first, second)):
            apart[which][:, number] = seen.point
            sample, way = ((side.start, share), (side.end, 1.0 - share))[which]
            moved = norm(seen.point - paths.point[:, sample[number]]) / np.maximum(way[number], NEAREST)
            motion[number] = np.maximum(motion[number], moved)
        with np.errstate(invalid="ignore"):     # points of rays along a plane may be infinitely far away
            return ~(norm(apart[0] - apart[1]) <= motion)

    def _middles(self, paths: Paths, spots: np.ndarray, cells: CellFaces, borders: np.ndarray
                 ) -> tuple[Paths, np.ndarray]:
        """Return the vertices in the middles of cells as paths, and their pixel positions (k, 2).

        Where a surface ends in a cell they lie on its border; `borders` (n,) is True for vertices there.
        """
        crossed = cells.around >= 0
        of_border = crossed & borders[cells.around]
        crossed = np.where(of_border.sum(axis=1, keepdims=True) > 1, of_border, crossed)
        spot = (spots[cells.around] * crossed[:, :, None]).sum(axis=1) / np.maximum(crossed.sum(axis=1), 1)[:, None]
        one, other = (paths.select(end) for end in cells.middles.T)
        normal = one.normal + other.normal
        size = norm(np.moveaxis(normal, 1, 0))
        half = {name: 0.5 * (getattr(one, name) + getattr(other, name))
                for name in ("place", "origin", "point", "length")}
        middle = replace(one, ray=unit(one.ray + other.ray), normal=normal / np.where(size > 0.0, size, 1.0)[:, None],
                         **half)
        return self._moved(middle, spot), spot

    def _rough(self, paths: Paths, at: np.ndarray, key: np.ndarray) -> np.ndarray:
        """Estimate at each point of the lattice the error of faces two steps long, as a share of the tolerance.

        The error is the deviation of the image. It is 0 if the neighbours have other keys. Return an array of the shape
        of `key`.
        """
        rough, inner = np.zeros(key.shape), key[1:-1, 1:-1]
        same = {(row, column): (key[1 + row:key.shape[0] - 1 + row, 1 + column:key.shape[1] - 1 + column] == inner)
                & (inner >= 0) for row in (-1, 0, 1) for column in (-1, 0, 1)}
        lattice = lambda row, column: at[1 + row:at.shape[0] - 1 + row, 1 + column:at.shape[1] - 1 + column]  # noqa: E731
        for first, last in (((0, -1), (0, 1)), ((-1, 0), (1, 0)), ((-1, -1), (1, 1)), ((-1, 1), (1, -1))):
            breathe()
            some = np.nonzero(same[first] & same[last])
            point = [paths.point[:, lattice(*step)[some]] for step in (first, (0, 0), last)]
            motion = 0.5 * norm(point[2] - point[0]) / np.hypot(*last)
            away = 0.5 * norm(point[0] + point[2] - 2.0 * point[1])
            bad = away / np.maximum(self.tolerance * motion / self.lattice.step, 1e-300)
            np.maximum.at(rough, (some[0] + 1, some[1] + 1), bad)
        return rough
