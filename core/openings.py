"""Openings: where the polygons leave the mesh open, found from how they meet and confirmed by rays.

Any edge of a polygon that should have a partner and has none tells places beside it that may be open. Where the missing
partner covers them after all, on other nodes, they are not. From the rest rays are traced backwards: a place is open if
no polygon near it shows the triangle that its ray meets first.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .backward_rays import first_hits
from .cameras import Cameras
from .candidates import Candidates
from .clipping import Polygons
from .coverage import covered, touching
from .mirror_map import MirrorMap
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .unmatched_edges import following_corners, unmatched_edges
from .vectors import dot, ranges
from .view import View

BESIDE = 0.25  # pixels from an edge at which rays look for what should be there
SPACING = 4.0  # pixels between rays along an edge
FRAME = 16.0  # pixels round the picture in which they look
MOST_PLACES = 32  # along one edge
SHORTEST_EDGE = 0.25  # pixels: an edge as long as an outline may miss opens nothing


@dataclass(frozen=True)
class Openings:
    """Places (n) that nothing covers.

    Attributes
    ----------
    camera : (n,) int64
    pixel : (n, 2) float64
    column : (n,) int64, in the frames, of the triangle that a ray meets there
    edges : int
        Edges without a partner that led there or were found to be no opening.
    rays : int
        How many rays were traced.
    """

    camera: np.ndarray
    pixel: np.ndarray
    column: np.ndarray
    edges: int
    rays: int

    def __len__(self) -> int:
        return len(self.camera)

    def select(self, chosen: np.ndarray) -> Openings:
        return Openings(self.camera[chosen], self.pixel[chosen], self.column[chosen], self.edges, self.rays)

    def joined(self, more: Openings) -> Openings:
        return Openings(*(np.concatenate((getattr(self, name), getattr(more, name)))
                          for name in ("camera", "pixel", "column")), self.edges, self.rays)


def find_openings(view: View, mirror_map: MirrorMap, cameras: Cameras, tree: SceneTree, frames: SceneFrames,
                  candidates: Candidates, polygons: Polygons, node_of: np.ndarray, pixels: np.ndarray,
                  watched: np.ndarray) -> Openings:
    """Openings beside the edges of the polygons that have no partner.

    Parameters
    ----------
    node_of : (k,) int64
        Node of each polygon corner.
    pixels : (n, 2) float64
        Picture positions of the nodes.
    watched : (n,) bool
        Cameras to look in.
    """
    if not watched.all():
        near = touching(cameras, np.flatnonzero(watched))[candidates.camera[polygons.pair]]
        node_of = node_of[np.repeat(near, np.diff(polygons.start))]
        polygons = polygons.select(near)
    edge, camera, partner = unmatched_edges(cameras, tree, frames, candidates, polygons, node_of)
    chosen = watched[camera]
    edge, camera, partner = edge[chosen], camera[chosen], partner[chosen]
    edges, corners = len(edge), pixels[node_of]
    row, pixel = _beside(polygons, corners, edge)
    camera, partner = camera[row], partner[row]
    pixel, place, ray = _moved_into(view, mirror_map, cameras, camera, pixel)
    outside = np.maximum(-pixel, pixel - view.resolution).max(axis=1) > FRAME
    doubtful = np.isfinite(place).all(axis=0) & ~outside
    doubtful &= ~covered(cameras, frames, candidates, polygons, corners, camera, partner, pixel)
    camera, pixel = camera[doubtful], pixel[doubtful]
    column = first_hits(tree, frames, place[:, doubtful], ray[:, doubtful])
    open_ = (column >= 0) & ~covered(cameras, frames, candidates, polygons, corners, camera, column, pixel)
    return Openings(camera[open_], pixel[open_], column[open_], edges, len(column))


def _beside(polygons: Polygons, corners: np.ndarray, edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places along polygon edges (e,), on the side away from the polygon: which of the edges, and the pixel."""
    size = np.diff(polygons.start)
    polygon = np.repeat(np.arange(len(size)), size)[edge]
    middle = np.stack([corners[polygons.start[polygon] + k] for k in range(3)]).mean(axis=0)
    start, way = corners[edge], corners[following_corners(polygons)[edge]] - corners[edge]
    length = np.linalg.norm(way, axis=1)
    count = np.where(length > SHORTEST_EDGE, np.clip(np.ceil(length / SPACING), 1, MOST_PLACES), 0).astype(np.int64)
    across = np.stack((-way[:, 1], way[:, 0]), axis=1) / np.where(length > 0.0, length, 1.0)[:, None]
    across *= -np.sign(((middle - start) * across).sum(axis=1))[:, None]
    step, row = ranges(np.zeros_like(count), count)
    share = (step + 0.5) / count[row]
    return row, start[row] + share[:, None] * way[row] + BESIDE * across[row]


def _moved_into(view: View, mirror_map: MirrorMap, cameras: Cameras, camera: np.ndarray,
                pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pixels (n, 2) moved into the cameras' outlines, with the place (3, n) on the mirror and the ray from there."""
    corners = view.pixels(cameras.places.T)[cameras.corners[camera]]
    u, v, offset = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], pixel - corners[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        weights = np.stack((offset[:, 0] * v[:, 1] - offset[:, 1] * v[:, 0],
                            u[:, 0] * offset[:, 1] - u[:, 1] * offset[:, 0])) / area
        weights = np.maximum(np.stack((1.0 - weights[0] - weights[1], *weights)), 0.0)
        pixel = np.einsum("kn,nkx->nx", weights / weights.sum(axis=0), corners)
    face = cameras.face[camera]
    origin, direction = (given.T for given in view.rays(pixel))
    flat = mirror_map.surface.flat[:, face]
    with np.errstate(divide="ignore", invalid="ignore"):
        place = origin + dot(mirror_map.surface.a[:, face] - origin, flat) / dot(direction, flat) * direction
    return pixel, place, mirror_map.rays(face, mirror_map.coordinates(face, place))
