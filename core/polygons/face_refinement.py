"""Error-bounded refinement of the reflected faces.

Inside a face, position and texture are interpolated; halfway along an edge the interpolated point and the one truly
seen there differ by a vector in the plane of the diffuse triangle. Divided by the true map's derivative it is a
displacement in pixels. Edges where it exceeds the tolerance are split at a point of the true map: an image of a diffuse
edge at the image of its point, any other at the middle in the picture.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import ALONG_UV, Cameras, ReflectionMap
from ..geometry import SceneFrames, columns, dot, falling, norm, shared_edges
from ..support import breathe
from ..views import View
from .polygon_corners import Nodes
from .triangulation import Faces

LEVELS = 10
EDGES_AT_ONCE = 32768
SHORTEST_EDGE = 0.25  # pixels
MARGIN = 2.0  # pixels round the picture: nobody sees an edge beyond
STRETCH = 4.0
NEAR_MIDDLE = 0.45  # of an edge: how far from its middle it may be split


@dataclass(frozen=True)
class FaceRefinement:
    """Splits faces on one mirror and one scene; `virtual` tells that faces are drawn at the virtual image's depth,
    `beyond` which cameras lie beyond the horizon, where there is nothing to be exact about."""

    cameras: Cameras
    frames: SceneFrames
    beyond: np.ndarray
    virtual: bool

    @property
    def _map(self) -> ReflectionMap:
        return self.cameras.mirror_map

    @property
    def _view(self) -> View:
        return self.cameras.view

    def refine(self, nodes: Nodes, faces: Faces, tolerance: float,
               maximum: int) -> tuple[Nodes, Faces, np.ndarray, int]:
        """Faces whose edges stray by less than `tolerance` pixels.

        Returns
        -------
        nodes, faces
        left : (2, e) float64
            The displacements estimated on the edges that stay, and the lengths of these, in pixels.
        limited : int
            Edges that the bound on depth or count left unsplit.
        """
        finished: list[Faces] = []
        left: list[np.ndarray] = []
        done = np.zeros((len(faces), 3), dtype=bool)
        pixels = self._view.pixels(nodes.place.T)
        for level in range(LEVELS + 1):
            if not len(faces):
                break
            breathe()
            marked, straying, chosen, middle = self._marked(nodes, pixels, faces, done, tolerance)
            ends, edge, choice, middle_nodes = middle
            stop = level == LEVELS or sum(map(len, finished)) + len(faces) + 2 * marked.sum() > maximum
            if stop or not marked.any():
                finished.append(faces)
                return nodes, Faces.joined(finished), np.concatenate((*left, straying), axis=1), int(marked.sum())
            left.append(straying[:, ~chosen])
            new = np.full(len(ends), -1)
            new[choice] = np.arange(marked.sum()) + len(nodes.distance)
            nodes = nodes.joined(*middle_nodes)
            pixels = np.concatenate((pixels, self._view.pixels(middle_nodes[0].T)))
            faces, done = faces.split(new[edge])
            resting = np.all(done, axis=1)
            finished.append(faces.select(resting))
            faces, done = faces.select(~resting), done[~resting]
        resting_left = np.concatenate((*left, np.zeros((2, 1))), axis=1)
        return nodes, Faces.joined(finished) if finished else faces, resting_left, 0

    def _marked(self, nodes: Nodes, pixels: np.ndarray, faces: Faces, done: np.ndarray, tolerance: float):
        """Edges to split between nodes at `pixels` (n, 2); of those that no neighbour has settled yet, what they stray
        by, their lengths, and whether they are to be split; and the nodes in their middles."""
        ends, first, edge = shared_edges(faces.nodes)
        face = first // 3
        open_ = np.flatnonzero(~done.reshape(-1)[first])
        marked = np.zeros(len(ends), dtype=bool)
        a, b = ends[open_].T
        camera, column = faces.camera[face[open_]], faces.column[face[open_]]
        breathe()
        mirror_face = self.cameras.face[camera]
        place = self._middle(nodes, a, b)
        breathe()
        shown = 0.5 * (nodes.point[:, a] + nodes.point[:, b])
        breathe()
        uv = self._map.coordinates(mirror_face, place)
        parts = []
        for start in range(0, max(len(column), 1), EDGES_AT_ONCE):
            breathe()
            part = slice(start, start + EDGES_AT_ONCE)
            parts.append(self._straying(mirror_face[part], uv[:, part], column[part], shown[:, part]))
        drift, error, point, distance = (np.concatenate(side, axis=-1) for side in zip(*parts))
        breathe()
        worth = np.zeros(len(ends), dtype=bool)
        worth[edge[~self.beyond[faces.camera]]] = True
        worth[open_] &= self._in_picture(pixels, a, b)
        breathe()
        drift, error = (np.where(worth[open_], value, 0.0) for value in (drift, error))
        length = np.sqrt(((columns(pixels.T, a) - columns(pixels.T, b))**2).sum(axis=0))
        # outlines are judged by pixels covered, interiors by displacement: an outline must be twice as straight
        outline = np.zeros(len(ends), dtype=bool)
        outline[edge[faces.on_scene_edge]] = True
        outline = outline[open_]
        straying = np.minimum(error, length)
        chosen = (np.minimum(np.where(outline, 2.0 * drift, error), length) > tolerance) & (length > SHORTEST_EDGE)
        breathe()
        along = np.flatnonzero(chosen & outline)
        if len(along):
            on_face, target = mirror_face[along], shown[:, along]
            found, s = self._map.locate(on_face, uv[:, along], distance[along], target)
            spot = self._map.places(on_face, found)
            away = np.linalg.norm(self._view.pixels(spot.T) - self._view.pixels(place[:, along].T), axis=1)
            good = (away <= NEAR_MIDDLE * length[along]) & self._map.meets(on_face, found, s, target)
            # an image at the edge's end, or none, straightens nothing however often the edge is split
            chosen[along[~good]] = False
            along = along[good]
            # a point of the edge: the triangle on its other side shares the node
            point[:, along], place[:, along], distance[along] = target[:, good], spot[:, good], s[good]
        marked[open_] = chosen
        place, point, distance = place[:, chosen], point[:, chosen], distance[chosen]
        return marked, np.stack((straying, length)), chosen, (ends, edge, marked, (place, point, distance))

    def _in_picture(self, pixels: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Which edges from nodes `a` to `b` (e,), at `pixels` (n, 2), are not all beside the picture."""
        inside = np.ones(len(a), dtype=bool)
        for place, size in zip(pixels.T, self._view.resolution):
            one, other = place[a], place[b]
            inside &= ~((np.maximum(one, other) < -MARGIN) | (np.minimum(one, other) > size + MARGIN))
        breathe()
        return inside

    def _middle(self, nodes: Nodes, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Where on the mirror the middle of a drawn edge is seen."""
        if not self.virtual or self._view.orthographic:
            return 0.5 * (nodes.place[:, a] + nodes.place[:, b])
        weight_a, weight_b = 1.0 + self._ways(nodes, a), 1.0 + self._ways(nodes, b)
        return (weight_a * nodes.place[:, a] + weight_b * nodes.place[:, b]) / (weight_a + weight_b)

    def _ways(self, nodes: Nodes, node: np.ndarray) -> np.ndarray:
        """How far behind the mirror nodes are seen, to their distance from the eye."""
        if not self._map.unit_rays:
            return nodes.distance[node]
        return nodes.distance[node] / norm(self._view.directions(nodes.place[:, node].T).T)

    def _straying(self, face: np.ndarray, uv: np.ndarray, column: np.ndarray, shown: np.ndarray):
        """Pixels between the places where `shown` is drawn and where it is truly seen, and as much of them as an eye
        could tell inside a face; what is truly seen there, and its s.

        Near a caustic the picture of a point is drawn out in one direction, and a shift in that direction shows
        nothing: none counts for more than `STRETCH` times the pixels it would be where the picture is drawn out least.
        """
        origin, ray, moves = self._map.linearise(face, uv, *ALONG_UV)
        frames = self.frames
        base, first, second, normal = (columns(row, column) for row in
                                       (frames.origin, frames.first, frames.second, frames.normal))
        speed = falling(normal, ray)
        s = np.maximum(dot(normal, base - origin) / speed, 0.0)
        point = origin + s * ray
        moving = []
        for move, change in moves:
            free = move + s * change
            moving.append(free - dot(normal, free) / speed * ray)
        off = shown - point
        (a, c), (b, d), right = ((dot(first, along), dot(second, along)) for along in (*moving, off))
        x, y = _solve(a, b, c, d, *right)
        place = self._map.places(face, uv)
        gradients = self._view.pixel_gradients(place)
        seen_u, seen_v = (np.stack([dot(gradient, span) for gradient in gradients]) for span in self._map.spans(face))
        drift = np.hypot(*(x * seen_u + y * seen_v))
        motion = [norm(x * moving[0] + y * moving[1]) for x, y in
                  (_solve(seen_u[0], seen_v[0], seen_u[1], seen_v[1], *step) for step in ((1.0, 0.0), (0.0, 1.0)))]
        with np.errstate(over="ignore"):
            coarse = norm(off) / np.maximum(np.maximum(*motion), 1e-300)
            return drift, np.minimum(drift, STRETCH * coarse), point, s


def _solve(a, b, c, d, right_x, right_y):
    """x, y with a x + b y = right_x and c x + d y = right_y; zero where a, b, c and d are."""
    straight, crossed = a * d, b * c
    determinant = straight - crossed
    # a map that rounding cannot tell from singular moves far, but not infinitely far
    least = 1e-14 * (np.abs(straight) + np.abs(crossed))
    determinant = np.where(np.abs(determinant) > least, determinant, least)
    inverse = np.divide(1.0, determinant, out=np.zeros_like(determinant), where=np.abs(determinant) > 1e-150)
    return (d * right_x - b * right_y) * inverse, (a * right_y - c * right_x) * inverse
