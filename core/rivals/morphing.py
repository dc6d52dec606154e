"""Reflection morphing: every diffuse vertex goes where the reflected ray that passes nearest to it leaves the mirror.

After E. Ofek, A. Rappoport, "Interactive reflections on curved objects", SIGGRAPH 1998, who tessellate the scene, find
a virtual vertex for each of its vertices and draw the virtual triangles; here the virtual vertex is searched among
rays, as C. Mei's talk has it. A vertex has one image: what a concave mirror shows twice is shown once.
"""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh, dot, norm, shared_edges, solve, split
from ..views import View
from .drawn_mesh import DrawnMesh
from .primary_hits import PrimaryHits
from .rival_picture import RivalPicture, Work
from .tracing import RayPyramid

ROUNDS = 12
LONGEST = 2.0  # steps of the grid of rays: longer edges of virtual triangles are split in the middle
SHORTEST = 4.0  # pixels: no edge is split that is shorter
UNSEEN = 4.0  # times longer may an edge be where no ray passes through either of its ends
SEEN = 1.5  # steps of the grid between a vertex and its ray up to which the mirror is taken to show it
BEYOND = 2.0  # steps of the grid: largest distance from its ray at which a vertex is placed
MOST = 400_000  # triangles


def morphed(view: View, mirror: TriangleMesh, scene: TriangleMesh, wanted: int, hits: PrimaryHits,
            rounds: int = ROUNDS) -> RivalPicture:
    """Search the vertices among about `wanted` rays of the primary hits, taken on a grid, and draw the triangles.

    `rounds` bounds how often the scene's triangles are split; 0 draws them as they are.
    """
    work = Work()
    rays = _Rays(view, hits, max(1, round(np.sqrt(len(hits.pixel) / wanted))))
    work.count(rays=int((rays.grid >= 0).sum()))
    work.done("tree")
    positions, triangles, source = scene.positions, scene.triangles, np.arange(len(scene.triangles))
    pixels, virtual, seen = rays.search(positions, work)
    longest = max(LONGEST * rays.step, SHORTEST)
    for _ in range(rounds):
        ends, _, edge = shared_edges(triangles)
        allowed = np.where(seen[ends].any(axis=1), longest, UNSEEN * longest)
        marked = np.linalg.norm(pixels[ends[:, 0]] - pixels[ends[:, 1]], axis=1) > allowed
        if not marked.any() or len(triangles) + 2 * int(marked.sum()) > MOST:
            break
        # middles come behind the vertices, in the order of their edges
        middle = len(positions) + np.cumsum(marked) - 1
        parent, local = split(marked[edge])
        corners = np.concatenate((triangles, middle[edge]), axis=1)
        triangles, source = np.take_along_axis(corners[parent], local, axis=1), source[parent]
        added = positions[ends[marked]].mean(axis=1)
        more = rays.search(added, work)
        positions = np.concatenate((positions, added))
        pixels, virtual, seen = (np.concatenate(parts) for parts in zip((pixels, virtual, seen), more))
        # drop triangles that no ray comes near to: they need no further splitting
        kept = seen[triangles].any(axis=1) | (_spread(pixels, triangles) > UNSEEN * longest)
        triangles, source = triangles[kept], source[kept]
    work.done("search")
    kept = seen[triangles].any(axis=1)
    if rounds:
        # drop triangles that stay large: their corners lie on both sides of a discontinuity of the reflection
        kept &= seen[triangles].all(axis=1) | (_spread(pixels, triangles) <= UNSEEN * longest)
    triangles, source = triangles[kept], source[kept]
    shown = DrawnMesh(virtual, triangles, source, positions, stencilled=True)
    found = shown.seen(view, hits.mirror_depth, hits.scene_depth)
    work.count(triangles=len(triangles))
    work.done("drawing")
    return work.picture(view.resolution, *found, shown)


def _spread(pixels: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    return np.ptp(pixels[triangles], axis=1).max(axis=1, initial=0.0)


class _Rays:
    """Rays of every `step`-th pixel of every `step`-th row that shows the mirror."""

    def __init__(self, view: View, hits: PrimaryHits, step: int) -> None:
        width, height = view.resolution
        self.view, self.step = view, step
        ray_of = np.full(width * height, -1)
        ray_of[hits.pixel] = np.arange(len(hits.pixel))
        self.grid = ray_of.reshape(height, width)[::step, ::step]
        self.columns = self.grid.shape[1]
        cell = np.flatnonzero(self.grid >= 0)
        taken = self.grid.ravel()[cell]
        self.places, self.rays = hits.place[:, taken], hits.ray[:, taken]
        index = np.full(self.grid.size, -1)
        index[cell] = np.arange(len(cell))
        self.index: np.ndarray = index.reshape(self.grid.shape)
        self.cell = cell
        self.pyramid = RayPyramid.build(self.index, self.places, self.rays)

    def search(self, points: np.ndarray, work: Work) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Find the images of `points` (v, 3) by the ray that passes nearest to each.

        Returns
        -------
        pixels : (v, 2) float64
        virtual : (v, 3) float64, places of the virtual images
        seen : (v,) bool, True if a ray of the mirror passes through the point, False if rays only pass near it
        """
        count = len(points)
        ray, visited = self.pyramid.nearest(points.T)
        work.count(traversals=count, projections=count, nodes=visited)
        place, way = self.places[:, ray], self.rays[:, ray]
        point = points.T
        s = np.maximum(dot(point - place, way), 0.0)
        (to_right, turn_right), (upward, turn_up) = self._change(ray, 0, 1), self._change(ray, 1, 0)
        across, up, further = solve(to_right + s * turn_right, upward + s * turn_up, way, point - place - s * way)
        move = np.stack((across, up))
        seen = (np.abs(move) <= SEEN).all(axis=0) & (s + further > 0.0)
        move = np.clip(move, -BEYOND, BEYOND)
        place = place + move[0] * to_right + move[1] * upward
        cell = self.cell[ray]
        pixels = self.step * (np.stack((cell % self.columns, cell // self.columns)) + move) + 0.5
        origins, directions = self.view.rays(pixels.T)
        length = norm(place - origins.T) + norm(point - place)
        return pixels.T, origins + length[:, None] * directions, seen

    def _change(self, ray: np.ndarray, lines: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the change (3, v) of place, and of direction, of each `ray` (v,) from one sample to the next.

        `lines` and `columns` give the direction on the grid. Differences are central, one-sided if only one neighbour
        exists, and zero if there is none.
        """
        line, column = self.cell[ray] // self.columns, self.cell[ray] % self.columns
        ends = []
        for sign in (1, -1):
            i, j = line + sign * lines, column + sign * columns
            inside = (i >= 0) & (i < self.index.shape[0]) & (j >= 0) & (j < self.index.shape[1])
            other = np.where(inside, self.index[np.where(inside, i, 0), np.where(inside, j, 0)], -1)
            ends.append(np.where(other >= 0, other, ray))
        apart = np.maximum((ends[0] != ray).astype(np.float64) + (ends[1] != ray), 1.0)
        return ((self.places[:, ends[0]] - self.places[:, ends[1]]) / apart,
                (self.rays[:, ends[0]] - self.rays[:, ends[1]]) / apart)
