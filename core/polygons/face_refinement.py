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
NEAR_MIDDLE = 0.45  # share of an edge's length: largest distance from its middle at which it may be split
QUARTER = 0.25  # share of an edge's length: a place as near to its middle is accepted without a search for a better one


@dataclass(frozen=True)
class FaceRefinement:
    """Splits faces on one mirror and one scene.

    Attributes
    ----------
    cameras : Cameras
    frames : SceneFrames
    beyond : (c,) bool, True for cameras that are slivers beyond the horizon, whose faces are not refined
    virtual : bool, True if faces are drawn at the virtual image's depth
    """

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
        """Split faces until their edges deviate by less than `tolerance` pixels, up to about `maximum` faces.

        Returns
        -------
        nodes : Nodes
        faces : Faces
        left : (2, e) float64, estimated displacements and lengths of the edges that stay, in pixels
        limited : int, number of edges that the bound on depth or count left unsplit
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
        """Find the edges to split, of `faces` between nodes at `pixels` (n, 2), and the nodes that split them.

        Returns
        -------
        marked : (e,) bool, True for edges to split
        strayed : (2, o) float64, deviation and length, in pixels, of the edges that are not `done` (f, 3) yet
        chosen : (o,) bool, True for those of them to split
        middle : tuple
            End nodes (e, 2) of the edges, edge of each side of the faces, `marked`, and the place, point and distance
            of the new nodes.
        """
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
        # if one end is many times as near as the other, the image of an edge's middle is far from its image's middle:
        # try the edge's middle first, then the point of the edge nearest to the point seen at the image's middle
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
        # do not split an edge without an image near its middle: that would never straighten it
        chosen[along[best > NEAR_MIDDLE * length[along]]] = False
        marked[open_] = chosen
        place, point, distance = place[:, chosen], point[:, chosen], distance[chosen]
        return marked, np.stack((left, length)), chosen, (ends, edge, marked, (place, point, distance))

    def _in_picture(self, pixels: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Return True for faces that may reach into the picture.

        A face may reach into it with all its corners outside, so that its edges outside matter too.

        Parameters
        ----------
        pixels : (n, 2) float64, of the nodes
        corners : (m, 3) int64, nodes of the faces
        """
        inside = np.ones(len(corners), dtype=bool)
        for place, size in zip(pixels.T, self._view.resolution):
            spots = np.take(place, corners.T)
            inside &= ~((largest(spots) < -MARGIN) | (smallest(spots) > size + MARGIN))
        breathe()
        return inside

    def _middle(self, nodes: Nodes, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Choose where to split the drawn edges from nodes `a` to `b` (e,): halfway in space, or in the picture.

        Edges are split halfway in the picture if one end is several times as near to the eye as the other: half of
        such an edge in space is little in the picture, however often it is halved.

        Returns
        -------
        share : (e,) float64, of the edge's length, from `a`
        place : (3, e) float64, on the mirror
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
        """Return path lengths behind the mirror of the nodes `node` (e,), relative to the mirror's distance."""
        if not self._map.unit_rays:
            return nodes.distance[node]
        return nodes.distance[node] / norm(self._view.directions(nodes.place[:, node].T).T)


def _nearest(points: np.ndarray, a: np.ndarray, b: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Return the points (3, e) on edges that are nearest to the points `seen` (3, e).

    The edges go from nodes `a` (e,) to `b` (e,) at `points` (3, n).
    """
    start, way = columns(points, a), columns(points, b) - columns(points, a)
    share = dot(seen - start, way) / np.maximum(dot(way, way), 1e-300)
    return start + np.clip(share, 0.0, 1.0) * way
