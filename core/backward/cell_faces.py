"""Faces over lattice cells without T-junctions: vertices on a cell's sides belong to the faces on both sides."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .cells import Cells, Labels

BEYOND = ((-1, 0), (0, 1), (1, 0), (0, -1))     # row and column offsets to the cells across each side


@dataclass(frozen=True)
class CellFaces:
    """Faces over the cells of a lattice, counterclockwise in the picture.

    Attributes
    ----------
    faces : (m, 3) int64, vertices; the k vertices in the middles of cells have the highest indices
    key : (m,) int64, key of the source triangle and bounces that each face shows
    middles : (k, 2) int64
        For each vertex in the middle of a cell, two vertices on the outlines of the same source around it.
    around : (k, 4) int64
        Up to four vertices on outlines at the cell's sides, -1 for none; the new one lies at their mean.
    """

    faces: np.ndarray
    key: np.ndarray
    middles: np.ndarray
    around: np.ndarray


def faces_of_cells(labels: Labels, divided: list[Cells], vertices: int) -> CellFaces:
    """Build the faces over all cells; new vertices in the middles of cells are numbered from `vertices` on."""
    used = np.zeros(labels.key.shape, dtype=bool)
    for cells in divided:
        for row in (0, cells.side):
            for column in (0, cells.side):
                used[cells.rows + row, cells.columns + column] = True
    parts: list = [(np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64))]
    middles, around = [np.zeros((0, 2), dtype=np.int64)], [np.zeros((0, 4), dtype=np.int64)]
    for cells in divided:
        ring = _Ring(labels, cells, used)
        parts += ring.select(ring.plain).whole_polygons()
        rest = ring.select(~ring.plain)
        faces, key, ends, crossed = rest.round_middles(vertices) if cells.side > 1 else rest.meeting_outlines(vertices)
        parts.append((faces, key))
        middles.append(ends)
        around.append(crossed)
        vertices += len(ends)
    return CellFaces(*map(np.concatenate, (*zip(*parts), middles, around)))


class _Ring:
    """Lattice points around cells of one size, and the vertices on outlines between these points."""

    def __init__(self, labels: Labels, cells: Cells, used: np.ndarray) -> None:
        self.labels, self.cells, self.used, side = labels, cells, used, cells.side
        at = cells.points()
        self.node, self.key, self.taken = labels.node[at], labels.key[at], used[at]
        self.leaving, self.arriving = cells.sides(labels.right, labels.up)
        self.change = self.key != np.roll(self.key, -1, axis=1)
        corner = np.zeros(4 * side, dtype=bool)
        corner[::side] = True
        self.count = self.change.sum(axis=1)
        # plain cells have no corners of smaller cells on their sides, and at most one outline
        self.plain = ~(self.taken & ~corner).any(axis=1) & (self.count <= 2)

    def select(self, chosen: np.ndarray) -> _Ring:
        cells = self.cells
        return _Ring(self.labels, Cells(cells.side, cells.rows[chosen], cells.columns[chosen]), self.used)

    def whole_polygons(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield faces (m, 3) over plain cells and their keys (m,); such cells have only corners and one outline."""
        side, none = self.cells.side, self.count == 0
        corner, key = self.node[:, ::side], self.key[:, ::side]
        yield np.concatenate((corner[none][:, [0, 1, 2]], corner[none][:, [0, 2, 3]])), np.tile(key[none, 0], 2)
        # find on each side of the cell the vertices of the outline that crosses it
        leaving, arriving = (values.reshape(len(values), 4, side).max(axis=2)
                             for values in (self.leaving, self.arriving))
        change = self.change.reshape(len(key), 4, side).any(axis=2)
        for first in range(4):
            for size in (1, 2, 3):
                run = [(first + step) % 4 for step in range(size)]
                chosen = change[:, first - 1] & (key[:, first] >= 0) & change[:, run[-1]]
                for step in run[:-1]:
                    chosen &= ~change[:, step]
                some = np.flatnonzero(chosen)
                polygon = [arriving[some, first - 1], *(corner[some, step] for step in run), leaving[some, run[-1]]]
                # build the fan from a corner, so that no face is a sliver along an outline
                hub = len(polygon) // 2
                polygon = polygon[hub:] + polygon[:hub]
                for second, third in zip(polygon[1:], polygon[2:]):
                    yield np.column_stack((polygon[0], second, third)), key[some, first]

    def round_middles(self, vertices: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Build fans around new vertices in the middle of each cell, one vertex for each key in the cell.

        The new vertices are numbered from `vertices` on.

        Returns
        -------
        faces : (m, 3) int64
        key : (m,) int64
        middles, around : (k, 2) and (k, 4) int64, of the new vertices, as in `CellFaces`
        """
        count, size = self.node.shape
        # order around each cell: a point, the outline vertex after it, the outline vertex before the next point, ...
        node = np.stack((np.where(self.taken, self.node, -1), np.where(self.change, self.leaving, -1),
                         np.where(self.change, self.arriving, -1)), axis=2).reshape(count, 3 * size)
        key = np.stack((self.key, self.key, np.roll(self.key, -1, axis=1)), axis=2).reshape(count, 3 * size)
        kind = np.tile(np.arange(3), size)
        cell, spot = np.nonzero(node >= 0)
        node, key, kind = node[cell, spot], key[cell, spot], kind[spot]
        begins = kind == 2
        # number the runs of one key by their first vertex; vertices before the first run belong to the cell's last run
        run = np.cumsum(begins) - 1
        runs_before = np.searchsorted(cell[begins], np.arange(count + 1))
        per_cell = np.diff(runs_before)
        wrapped = run < runs_before[cell]
        run = np.where(wrapped, runs_before[cell] + per_cell[cell] - 1, run)
        half = self.cells.side // 2
        centre = self.labels.node[self.cells.rows + half, self.cells.columns + half]
        hub = np.where(per_cell[cell] > 0, vertices + run, centre[cell])
        following = np.arange(len(cell)) + 1
        first = np.searchsorted(cell, np.arange(count))
        filled = np.flatnonzero(np.bincount(cell, minlength=count))
        last = np.searchsorted(cell, filled, side="right") - 1
        following[last] = first[filled]
        open_ = kind != 1
        faces = np.column_stack((hub, node, node[following]))[open_]
        ends = np.column_stack((node[begins], np.zeros(int(begins.sum()), dtype=np.int64)))
        closes = kind == 1
        ends[run[closes], 1] = node[closes]
        crossed = np.where(self.change, np.maximum(self.leaving, self.arriving), -1)
        crossed = -np.sort(-crossed, axis=1)[:, :4]
        return faces, key[open_], ends, crossed[cell[begins]]

    def meeting_outlines(self, vertices: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Build faces over cells that are one lattice step wide and that outlines cross on three or four sides.

        Each run of neighbouring corners with the same key, except -1, gets a new vertex. All new vertices of a cell lie
        at one place, its middle, which follows from `around`. Between two such cells the outline is a straight line
        from middle to middle.

        Parameters
        ----------
        vertices : int, number of the first new vertex

        Returns
        -------
        faces : (m, 3) int64, vertices, counterclockwise in the picture
        key : (m,) int64, key of what each face shows, as in `CellFaces`
        middles : (k, 2) int64, for each new vertex the two outline vertices between which its run of corners lies
        around : (k, 4) int64, for each new vertex an outline vertex on each side of its cell, -1 for none
        """
        change, count = self.change, len(self.cells)
        run = np.cumsum(np.roll(change, 1, axis=1), axis=1) - 1
        run = np.where(run < 0, run.max(axis=1, keepdims=True), run)
        shown, number = np.unique((4 * np.arange(count)[:, None] + run)[self.key >= 0], return_inverse=True)
        hub = np.full((count, 4), -1)
        hub[self.key >= 0] = vertices + number
        ends = np.zeros((len(shown), 2), dtype=np.int64)
        begins = np.roll(change, 1, axis=1) & (self.key >= 0)
        ends[hub[begins] - vertices, 0] = np.roll(self.arriving, 1, axis=1)[begins]
        closes = change & (self.key >= 0)
        ends[hub[closes] - vertices, 1] = self.leaving[closes]
        around = np.where(change, np.maximum(self.leaving, self.arriving), -1)[shown // 4]
        faces, keys = map(np.concatenate, zip(*self._round_hubs(hub)))
        return faces, keys, ends, around

    def _round_hubs(self, hub: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield faces (m, 3) over cells of one step, and their keys (m,).

        `hub` (n, 4) holds the middle vertex for the key at each corner of each cell, -1 for none.
        """
        shape, (rows, columns), change = self.labels.key.shape, (self.cells.rows, self.cells.columns), self.change
        middle = np.full((4, *shape), -1)
        meeting = np.zeros(shape, dtype=bool)
        meeting[rows, columns] = True
        middle[:, rows, columns] = hub.T

        def faces(*triangle: np.ndarray, key: np.ndarray, where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            some = np.flatnonzero(where & (key >= 0))
            return np.column_stack([corner[some] for corner in triangle]), key[some]

        beyond = [(np.maximum(rows + row, 0), np.maximum(columns + column, 0)) for row, column in BEYOND]
        straight = np.stack([change[:, k] & meeting[at] for k, at in enumerate(beyond)], axis=1)
        for k in range(4):
            following, own = (k + 1) % 4, self.key[:, k]
            bent = change[:, k] & ~straight[:, k]
            yield faces(hub[:, k], self.node[:, k], self.node[:, following], key=own, where=~change[:, k])
            yield faces(hub[:, k], self.node[:, k], self.leaving[:, k], key=own, where=bent)
            yield faces(hub[:, following], self.arriving[:, k], self.node[:, following], key=self.key[:, following],
                        where=bent)
            # this corner's number in the cell across this side is (k + 3) % 4
            across = middle[(k + 3) % 4][beyond[k]]
            yield faces(self.node[:, k], across, hub[:, k], key=own, where=straight[:, k])
