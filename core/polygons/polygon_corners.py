"""Nodes: the exact corners of all reflected polygons, each computed once and shared by the polygons round it.

Three kinds bound every reflected triangle (S. Vallance, P. Calder, ACSC 2006): a scene vertex in a camera, a scene
edge over a mirror edge, and a mirror corner's ray on a scene triangle. A fourth lies where mirror and scene touch.
Clipping finds which of them a polygon has from linear functions; here each gets its place on the true reflection map.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..cameras import Cameras, ReflectionMap
from ..geometry import ColumnArrays, SceneFrames, columns, dot, groups, others
from ..support import breathe
from ..views import box
from .clipping import Polygons
from .convex_polygons import Line
from .vertex_images import NEAR_IMAGE, VertexImages

BESIDE = 0.5  # pixels: how far corners may lie beside their camera, whose sides are straight where the map is not
WELD = 1e-9  # share of the extent of all nodes: nodes closer than this are merged


@dataclass(frozen=True)
class Nodes(ColumnArrays):
    """Nodes (n).

    Attributes
    ----------
    place : (3, n) float64, Q on the mirror
    point : (3, n) float64, the diffuse point seen there
    distance : (n,) float64, s
    """

    place: np.ndarray
    point: np.ndarray
    distance: np.ndarray


@dataclass(frozen=True)
class _Corners:
    """Corners (k) of the polygons, before they become nodes.

    Attributes
    ----------
    cameras : Cameras
    frames : SceneFrames
    camera, column : (k,) int64, of the polygon of each corner
    weights : (3, k) float64, in the camera
    low, high : (k,) int64, labels of the two lines that meet in each corner
    images : VertexImages, images of the scene's vertices
    """

    cameras: Cameras
    frames: SceneFrames
    camera: np.ndarray
    column: np.ndarray
    weights: np.ndarray
    low: np.ndarray
    high: np.ndarray
    images: VertexImages

    @property
    def mirror_map(self) -> ReflectionMap:
        return self.cameras.mirror_map

    def guess(self, chosen: np.ndarray) -> np.ndarray:
        """Return the places (3, n) on the mirror where linear clipping puts the corners `chosen` (n,)."""
        corners = self.cameras.corners[self.camera[chosen]].T
        return (np.take(self.cameras.places, corners, axis=1) * self.weights[:, chosen]).sum(axis=1)

    def near(self, chosen: np.ndarray, moved: np.ndarray, guess: np.ndarray) -> np.ndarray:
        """Return True for places `moved` (3, n) that stay near their `guess` (3, n) and near their camera.

        A place that is farther away, by more than a straight outline may miss, is another image, or Newton's method
        diverged on a triangle seen edge on.
        """
        view = self.cameras.view
        with np.errstate(invalid="ignore", over="ignore"):
            pixel = view.pixels(moved.T)
            away = np.linalg.norm(pixel - view.pixels(guess.T), axis=1)
            low, high = (columns(side, self.camera[chosen]) for side in self._boxes)
            beside = np.maximum(low - pixel.T, pixel.T - high)
            return (away < NEAR_IMAGE) & (beside[0] < BESIDE) & (beside[1] < BESIDE)

    @cached_property
    def _boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (2, c) of the cameras' bounding boxes in the picture, in pixels."""
        return box(columns(self.cameras.view.pixels(self.cameras.places.T).T, self.cameras.corners.T))

    def seen(self, chosen: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the point (3, n) where the true ray at each `place` (3, n) meets the triangle's plane, and its s."""
        face = self.cameras.face[self.camera[chosen]]
        origin, ray = self.mirror_map.leave(face, self.mirror_map.coordinates(face, place))
        s = np.maximum(self.frames.distance(self.column[chosen], origin, ray), 0.0)
        return origin + s * ray, s

    def mirror_edge(self, chosen: np.ndarray, label: np.ndarray) -> np.ndarray:
        """Return the two camera corners (n, 2), sorted, of the mirror edge with each `label` (n,)."""
        first = 3 * self.camera[chosen]
        return _rising(*(columns(self.cameras.corners.ravel(), first + corner) for corner in others(label)))

    def scene_edge(self, chosen: np.ndarray, label: np.ndarray) -> np.ndarray:
        """Return the two scene vertices (n, 2), sorted, of the triangle's edge with each `label` (n,)."""
        vertices, side, column = self.frames.vertices, label - Line.SCENE_EDGE, self.column[chosen]
        return _rising(*(columns(vertices.ravel(), corner * vertices.shape[1] + column) for corner in others(side)))


def _rising(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Stack two arrays (n,) as (n, 2), the smaller entry first."""
    return np.stack((np.minimum(one, other), np.maximum(one, other)), axis=1)


def polygon_nodes(polygons: Polygons, images: VertexImages) -> tuple[Nodes, np.ndarray]:
    """Compute the nodes of the polygons, and the index (k,) of the node of each polygon corner."""
    size, before = polygons.size, polygons.before
    low = np.minimum(before, polygons.after).astype(np.int64)
    high = np.maximum(before, polygons.after).astype(np.int64)
    corners = _Corners(polygons.candidates.cameras, polygons.candidates.frames, np.repeat(polygons.camera, size),
                       np.repeat(polygons.column, size), polygons.weights, low, high, images)
    node_of = np.empty(len(low), dtype=np.int64)
    made, count = [], 0
    on_mirror_edge = low < Line.SCENE_EDGE
    kinds = ((_mirror_corners, on_mirror_edge & (high < Line.SCENE_EDGE)),
             (_crossings, on_mirror_edge & (high >= Line.SCENE_EDGE) & (high < Line.CONTACT)),
             (_vertices, ~on_mirror_edge & (high < Line.CONTACT)),
             (_contacts_of_mirror_edges, on_mirror_edge & (high == Line.CONTACT)),
             (_contacts_of_scene_edges, ~on_mirror_edge & (high == Line.CONTACT)),
             (_on_lines_of_hiding, high == Line.HIDDEN))
    for kind, chosen in kinds:
        chosen = np.flatnonzero(chosen)
        if len(chosen):
            breathe()
            part, shared = kind(corners, chosen)
            made.append(part)
            node_of[chosen] = shared + count
            count += len(part[2])
    if not made:
        return Nodes(np.zeros((3, 0)), np.zeros((3, 0)), np.zeros(0)), node_of
    return Nodes(*(np.concatenate(side, axis=-1) for side in zip(*made))), node_of


def _mirror_corners(corners: _Corners, chosen: np.ndarray):
    camera, column = corners.camera[chosen], corners.column[chosen]
    corner = corners.cameras.corners[camera, 3 - corners.low[chosen] - corners.high[chosen]]
    first, group = groups(corner, column)
    corner, column = corner[first], column[first]
    origin, ray = corners.cameras.origins[:, corner], corners.cameras.rays[:, corner]
    distance = np.maximum(corners.frames.distance(column, origin, ray), 0.0)
    return (corners.cameras.places[:, corner], origin + distance * ray, distance), group


def _crossings(corners: _Corners, chosen: np.ndarray):
    mirror_edge = corners.mirror_edge(chosen, corners.low[chosen])
    scene_edge = corners.scene_edge(chosen, corners.high[chosen])
    first, group = groups(*mirror_edge.T, *scene_edge.T)
    mirror_edge, scene_edge, chosen = mirror_edge[first], scene_edge[first], chosen[first]
    places, mirror_map = corners.cameras.places, corners.mirror_map
    face = corners.cameras.face[corners.camera[chosen]]
    start, end = places[:, mirror_edge[:, 0]], places[:, mirror_edge[:, 1]]
    place = corners.guess(chosen)
    way = end - start
    t = _share(place - start, way)
    uv_start, uv_end = mirror_map.coordinates(face, start), mirror_map.coordinates(face, end)
    seen, seen_s = corners.seen(chosen, place)
    point = corners.frames.positions[scene_edge[:, 0]].T
    edge = corners.frames.positions[scene_edge[:, 1]].T - point
    t, along, s = mirror_map.meet(face, (uv_start, uv_end), (point, edge), (t, seen_s))
    met = start + np.clip(t, 0.0, 1.0) * way
    near = corners.near(chosen, met, place) & (s >= 0.0)
    # just beyond an end of the edge, by no more than straight outlines miss, the end stands in
    along = np.clip(np.where(near, along, _share(seen - point, edge)), 0.0, 1.0)
    return (np.where(near, met, place), point + along * edge, np.where(near, s, seen_s)), group


def _share(offset: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Return the share (n,) of each vector `way` (3, n) that an offset covers along it; 0 for a way without length."""
    square = dot(way, way)
    return np.divide(dot(offset, way), square, out=np.zeros_like(square), where=square > 0.0)


def _vertices(corners: _Corners, chosen: np.ndarray):
    camera, column, images = corners.camera[chosen], corners.column[chosen], corners.images
    side = 3 - (corners.low[chosen] - Line.SCENE_EDGE) - (corners.high[chosen] - Line.SCENE_EDGE)
    vertex = corners.frames.vertices[side, column]
    guess = corners.guess(chosen)
    image = images.nearest(vertex, camera, corners.cameras.view.pixels(guess.T).T)
    breathe()
    named = np.flatnonzero(image >= 0)
    image[named[~corners.near(chosen[named], images.place[:, image[named]], guess[:, named])]] = -1
    # a vertex on the wrong side of a bent mirror edge by less than the linear clip sees has no image of its own here
    lone = image < 0
    first, group = groups(np.where(lone, camera, -1) + 1, np.where(lone, vertex + len(images.vertex), image))
    image, lone = image[first], lone[first]
    place, distance = np.empty((3, len(first))), np.empty(len(first))
    place[:, ~lone], distance[~lone] = images.place[:, image[~lone]], images.distance[image[~lone]]
    point = corners.frames.positions[vertex[first]].T
    own = first[lone]
    face, mirror_map = corners.cameras.face[camera[own]], corners.mirror_map
    start = guess[:, own]
    _, seen_s = corners.seen(chosen[own], start)
    moved, found = mirror_map.locate(face, mirror_map.coordinates(face, start), seen_s, point[:, lone])
    moved_place = mirror_map.places(face, moved)
    near = corners.near(chosen[own], moved_place, start) & mirror_map.meets(face, moved, found, point[:, lone])
    place[:, lone] = np.where(near, moved_place, start)
    distance[lone] = np.where(near, found, seen_s)
    return (place, point, distance), group


def _contacts_of_mirror_edges(corners: _Corners, chosen: np.ndarray):
    mirror_edge = corners.mirror_edge(chosen, corners.low[chosen])
    first, group = groups(*mirror_edge.T, corners.column[chosen])
    return _contact(corners, chosen[first]), group


def _contacts_of_scene_edges(corners: _Corners, chosen: np.ndarray):
    scene_edge = corners.scene_edge(chosen, corners.low[chosen])
    # an edge goes through the mirror once; straight outlines that run along the line of contact meet it in every camera
    first, group = groups(corners.camera[chosen], *scene_edge.T)
    return _contact(corners, chosen[first]), group


def _on_lines_of_hiding(corners: _Corners, chosen: np.ndarray):
    place = corners.guess(chosen)
    point, distance = corners.seen(chosen, place)
    # neighbours cannot identify these lines by a label: merge corners that lie in one place
    both = np.concatenate((place, point))
    low, size = both.min(axis=1, keepdims=True), np.ptp(both, axis=1).max()
    first, group = groups(*np.rint((both - low) / (WELD * max(size, 1e-300))).astype(np.int64))
    return (place[:, first], point[:, first], distance[first]), group


def _contact(corners: _Corners, chosen: np.ndarray):
    place = corners.guess(chosen)
    face = corners.cameras.face[corners.camera[chosen]]
    origin, _ = corners.mirror_map.leave(face, corners.mirror_map.coordinates(face, place))
    return place, origin, np.zeros(len(chosen))
