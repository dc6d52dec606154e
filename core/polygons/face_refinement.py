"""Error-bounded refinement of the reflected faces.

Inside a face, position and texture are interpolated; halfway along an edge the interpolated point and the one truly
seen there differ by a vector in the plane of the diffuse triangle. Divided by the true map's derivative it is a
displacement in pixels. Edges where it exceeds the tolerance are split at a point of the true map: an image of a diffuse
edge at the image of its point, any other at the middle in the picture.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, ReflectionMap
from ..geometry import SceneFrames, columns, dot, largest, mask, norm, numbered, shared_edges, smallest
from ..support import breathe
from ..views import View
from .polygon_corners import Nodes
from .straying import straying
from .triangulation import Faces

LEVELS = 20
SHORTEST_EDGE = 0.25  # pixels
MARGIN = 2.0  # pixels round the picture: nobody sees a face beyond
FORESHORTENED = 4.0  # times as far from the eye's plane as its other end: an edge that is halved in the picture
NEAR_MIDDLE = 0.45  # of an edge: how far from its middle it may be split
QUARTER = 0.25  # of an edge: no farther than that from its middle no better place is looked for


@dataclass(frozen=True)
class FaceRefinement:
    """Splits faces on one mirror and one scene; `virtual` tells that faces are drawn at the virtual image's depth,
    `beyond` which cameras are slivers beyond the horizon, where there is nothing to be exact about."""

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
        left : (2, e) float64, the displacements estimated on the edges that stay, and the lengths of these, in pixels
        limited : int, edges that the bound on depth or count left unsplit
        """
        finished: list[Faces] = []
        left: list[np.ndarray] = []
        done = np.zeros((len(faces), 3), dtype=bool)
        pixels = self._view.pixels(nodes.place.T)
        for level in range(LEVELS + 1):
            if not len(faces):
                break
            breathe()
            marked, strayed, chosen, middle = self._marked(nodes, pixels, faces, done, tolerance)
            ends, edge, choice, middle_nodes = middle
            stop = level == LEVELS or sum(map(len, finished)) + len(faces) + 2 * marked.sum() > maximum
            if stop or not marked.any():
                finished.append(faces)
                return nodes, Faces.joined(finished), np.concatenate((*left, strayed), axis=1), int(marked.sum())
            left.append(strayed[:, ~chosen])
            new = numbered(len(ends), choice, len(nodes))
            nodes = nodes.joined((nodes, Nodes(*middle_nodes)))
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
        share, place = self._middle(nodes, a, b)
        breathe()
        shown = (1.0 - share) * nodes.point[:, a] + share * nodes.point[:, b]
        breathe()
        uv = self._map.coordinates(mirror_face, place)
        drift, error, point, distance = straying(self.cameras, self.frames, mirror_face, uv, column, shown)
        breathe()
        worth = mask(len(ends), edge[~self.beyond[faces.camera] & self._in_picture(pixels, faces.nodes)])
        drift, error = (np.where(worth[open_], value, 0.0) for value in (drift, error))
        length = np.sqrt(((columns(pixels.T, a) - columns(pixels.T, b))**2).sum(axis=0))
        # outlines are judged by pixels covered, interiors by displacement: an outline must be twice as straight
        outline = mask(len(ends), edge[faces.on_scene_edge])[open_]
        left = np.minimum(error, length)
        chosen = (np.minimum(np.where(outline, 2.0 * drift, error), length) > tolerance) & (length > SHORTEST_EDGE)
        breathe()
        along = np.flatnonzero(chosen & outline)
        # an end many times as near as the other: the edge's middle is seen far from the middle of its image, and what
        # is seen there is nearest to another point of it
        middle, seen, guess = place[:, along], point[:, along], distance[along]
        best = np.full(len(along), np.inf)
        for target in (shown[:, along], _nearest(nodes.point, a[along], b[along], seen)):
            asked = np.flatnonzero(best > QUARTER * length[along])
            if not len(asked):
                break
            own, target = along[asked], target[:, asked]
            found, s = self._map.locate(mirror_face[own], uv[:, own], guess[asked], target)
            spot = self._map.places(mirror_face[own], found)
            away = np.linalg.norm(self._view.pixels(spot.T) - self._view.pixels(middle[:, asked].T), axis=1)
            nearer = (away < best[asked]) & self._map.meets(mirror_face[own], found, s, target)
            # a point of the edge: the triangle on its other side shares the node
            settled = own[nearer]
            best[asked[nearer]] = away[nearer]
            point[:, settled], place[:, settled], distance[settled] = target[:, nearer], spot[:, nearer], s[nearer]
        # an image at the edge's end, or none, straightens nothing however often the edge is split
        chosen[along[best > NEAR_MIDDLE * length[along]]] = False
        marked[open_] = chosen
        place, point, distance = place[:, chosen], point[:, chosen], distance[chosen]
        return marked, np.stack((left, length)), chosen, (ends, edge, marked, (place, point, distance))

    def _in_picture(self, pixels: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Which faces with nodes `corners` (m, 3), at `pixels` (n, 2), are not all beside the picture: what a face
        shows in it is decided by its edges beside it too."""
        inside = np.ones(len(corners), dtype=bool)
        for place, size in zip(pixels.T, self._view.resolution):
            spots = np.take(place, corners.T)
            inside &= ~((largest(spots) < -MARGIN) | (smallest(spots) > size + MARGIN))
        breathe()
        return inside

    def _middle(self, nodes: Nodes, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far along drawn edges from nodes `a` to `b` (e,) each is best split, and where on the mirror that is.

        That is halfway, or, where an end is several times as near as the other, halfway in the picture: half of such an
        edge in space is little in the picture, however often it is halved.
        """
        start, end = (nodes.place[:, node] for node in (a, b))
        if self._view.orthographic:
            return np.full(len(a), 0.5), 0.5 * (start + end)
        weight_a, weight_b = (1.0 + self._ways(nodes, a), 1.0 + self._ways(nodes, b)) if self.virtual else (1.0, 1.0)
        depth_a, depth_b = self._view.depths(start.T) * weight_a, self._view.depths(end.T) * weight_b
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = depth_a / depth_b
            share = np.where((ratio > FORESHORTENED) | ((ratio > 0.0) & (ratio < 1.0 / FORESHORTENED)),
                             depth_a / (depth_a + depth_b), 0.5)
        weight_a, weight_b = (1.0 - share) * weight_a, share * weight_b
        return share, (weight_a * start + weight_b * end) / (weight_a + weight_b)

    def _ways(self, nodes: Nodes, node: np.ndarray) -> np.ndarray:
        """How far behind the mirror nodes are seen, to their distance from the eye."""
        if not self._map.unit_rays:
            return nodes.distance[node]
        return nodes.distance[node] / norm(self._view.directions(nodes.place[:, node].T).T)


def _nearest(points: np.ndarray, a: np.ndarray, b: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The points (3, e) of edges from nodes `a` to `b` (e,) at `points` (3, n) that are nearest to what is `seen`."""
    start, way = columns(points, a), columns(points, b) - columns(points, a)
    share = dot(seen - start, way) / np.maximum(dot(way, way), 1e-300)
    return start + np.clip(share, 0.0, 1.0) * way
