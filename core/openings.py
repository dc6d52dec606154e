"""Openings: where the polygons leave the mesh open, found from how they meet and confirmed by rays.

Each edge of a polygon has a partner on the same two nodes. Over a camera's edge it is the same triangle's polygon in
the neighbouring camera; over a scene edge, the neighbouring triangle's in the same camera, on the other side or, where
the surface turns away, on the same. Edges are without a partner by right on the border of the mirror, of the scene and
of a contact. Any other tells places beside it that may be open. Where the missing partner covers them after all, on
other nodes, they are not. From the rest rays are traced backwards: a place is open if no polygon near it shows the
triangle that its ray meets first.
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from .backward_rays import first_hits
from .cameras import Cameras
from .candidates import Candidates
from .clipping import CONTACT, SCENE_EDGE, Polygons
from .mirror_map import MirrorMap
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .subdivision import shared_edges
from .vectors import dot, ranges
from .view import View

BESIDE = 0.25  # pixels from an edge at which rays look for what should be there
SPACING = 4.0  # pixels between rays along an edge
FRAME = 16.0  # pixels round the picture in which they look
MOST_PLACES = 32  # along one edge
SHORTEST_EDGE = 0.25  # pixels: an edge as long as an outline may miss opens nothing
PAIRS_AT_ONCE = 1 << 20
CELL, CELLS = 4.0, 4096  # pixels; cells across all that is told apart
MARGIN = 0.1  # pixels by which a polygon may end before the place that it covers


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


def unmatched_edges(cameras: Cameras, tree: SceneTree, frames: SceneFrames, candidates: Candidates,
                    polygons: Polygons, node_of: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Polygon edges without a partner that should have one.

    Returns
    -------
    edge : (e,) int64
        The polygon corners where they start.
    camera : (e,) int64
        The camera in which the partner is missing.
    partner : (e,) int64
        Its triangle's column in the frames, -1 where the frames do not have it.
    """
    start, end = node_of, node_of[following_corners(polygons)]
    inner = polygons.after < CONTACT
    proper = np.flatnonzero((start != end) & inner)
    low, high = np.minimum(start, end)[proper], np.maximum(start, end)[proper]
    _, pair, uses = np.unique(low * (int(node_of.max(initial=0)) + 1) + high, return_inverse=True, return_counts=True)
    odd = proper[uses[pair] % 2 == 1]
    of = np.repeat(polygons.pair, np.diff(polygons.start))[odd]
    camera, column, label = candidates.camera[of], candidates.column[of], polygons.after[odd].astype(np.int64)
    on_mirror = label < SCENE_EDGE
    expected = np.zeros(len(odd), dtype=bool)
    beyond = _across(cameras, camera[on_mirror], label[on_mirror])
    camera[on_mirror], expected[on_mirror] = beyond, beyond >= 0
    neighbour = _neighbour(tree, frames, column[~on_mirror], label[~on_mirror] - SCENE_EDGE)
    of_neighbour, known = frames.columns(neighbour)
    column[~on_mirror], expected[~on_mirror] = np.where(known, of_neighbour, -1), neighbour >= 0
    return odd[expected], camera[expected], column[expected]


def touching(cameras: Cameras, camera: np.ndarray) -> np.ndarray:
    """(n,) bool, which cameras share a corner with one of `camera`."""
    corner = np.zeros(cameras.places.shape[1], dtype=bool)
    corner[cameras.corners[camera]] = True
    return corner[cameras.corners].any(axis=1)


def following_corners(polygons: Polygons) -> np.ndarray:
    """(k,) int64, of each polygon corner the next one round."""
    following = np.arange(1, len(polygons.after) + 1)
    following[polygons.start[1:] - 1] = polygons.start[:-1]
    return following


def _neighbour(tree: SceneTree, frames: SceneFrames, column: np.ndarray, side: np.ndarray) -> np.ndarray:
    """The triangle with an area beyond the scene edge opposite vertex `side`, -1 where there is none or several."""
    row, mesh = np.arange(len(column)), tree.mesh
    vertices = frames.vertices[:, column]
    asked = np.sort(np.stack((vertices[(side + 1) % 3, row], vertices[(side + 2) % 3, row])), axis=0)
    touched = np.zeros(len(mesh.positions), dtype=bool)
    touched[asked] = True
    near = tree.leaf_triangles[touched[mesh.triangles[tree.leaf_triangles]].sum(axis=1) >= 2]
    ends, _, edge = shared_edges(mesh.triangles[near])
    uses, other = _uses(edge, near)
    count = len(mesh.positions)
    # the triangle that is asked about has an area itself: its edges are among them
    here = np.searchsorted(ends[:, 0] * count + ends[:, 1], asked[0] * count + asked[1])
    return np.where(uses[here] == 2, other[here] - frames.triangle[column], -1)


def _across(cameras: Cameras, camera: np.ndarray, label: np.ndarray) -> np.ndarray:
    """The camera beyond the edge opposite corner `label`, -1 where there is none or more than one."""
    _, _, edge = shared_edges(cameras.corners)
    uses, both = _uses(edge, np.arange(len(cameras)))
    here = edge[camera, (label + 1) % 3]
    return np.where(uses[here] == 2, both[here] - camera, -1)


def _uses(edge: np.ndarray, name: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many triangles have each of the edges (n, 3), and the sum of these triangles' names (n,)."""
    total = np.bincount(edge.ravel(), weights=np.repeat(name, 3).astype(np.float64))
    return np.bincount(edge.ravel()), total.astype(np.int64)


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


def covered(cameras: Cameras, frames: SceneFrames, candidates: Candidates, polygons: Polygons,
            corner_pixels: np.ndarray, camera: np.ndarray, column: np.ndarray, pixel: np.ndarray) -> np.ndarray:
    """Whether a polygon of triangle `column` (n,), in `camera` (n,) or one that touches it, covers `pixel` (n, 2);
    never where the column is -1.

    Parameters
    ----------
    corner_pixels : (k, 2) float64
        Picture positions of the polygons' corners.
    """
    inside = np.zeros(len(camera), dtype=bool)
    wanted = np.zeros(len(frames.triangle), dtype=bool)
    wanted[column[column >= 0]] = True
    of_camera, of_column = candidates.camera[polygons.pair], candidates.column[polygons.pair]
    chosen = np.flatnonzero(touching(cameras, camera)[of_camera] & wanted[of_column])
    pairs = np.zeros(0, dtype=np.int64)
    if len(chosen):
        low, high = (bound.reduceat(corner_pixels, polygons.start[:-1], axis=0)[chosen] + room
                     for bound, room in ((np.minimum, -MARGIN), (np.maximum, MARGIN)))
        shown = cameras.corners[of_camera[chosen]] * len(wanted) + of_column[chosen][:, None]
        asked = np.flatnonzero(column >= 0)
        wished = cameras.corners[camera[asked]] * len(wanted) + column[asked][:, None]
        for own, place in _in_one_cell(shown, low, high, wished, pixel[asked]):
            near = ((pixel[asked[place]] >= low[own]) & (pixel[asked[place]] <= high[own])).all(axis=1)
            pairs = np.union1d(pairs, asked[place[near]] * len(polygons.pair) + chosen[own[near]])
    place, polygon = pairs // max(len(polygons.pair), 1), pairs % max(len(polygons.pair), 1)
    size = np.diff(polygons.start)[polygon]
    corner, run = ranges(polygons.start[polygon], size)
    if not len(run):
        return inside
    a, b, at = corner_pixels[corner], corner_pixels[following_corners(polygons)[corner]], pixel[place[run]]
    way, offset = b - a, at - a
    square = (way**2).sum(axis=1)
    share = np.clip((offset * way).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away = np.linalg.norm(offset - share[:, None] * way, axis=1)
    # moved onto the true map, polygons need not be convex: count the edges that a line to the right crosses
    above = a[:, 1] > at[:, 1]
    left = (way[:, 0] * offset[:, 1] - way[:, 1] * offset[:, 0]) * np.where(above, -1.0, 1.0) > 0.0
    crossed = (above != (b[:, 1] > at[:, 1])) & left
    begin = np.cumsum(size) - size
    within = np.add.reduceat(crossed.astype(np.int64), begin) % 2 == 1
    within |= np.minimum.reduceat(away, begin) <= MARGIN
    inside[place[within]] = True
    return inside


def _in_one_cell(shown: np.ndarray, low: np.ndarray, high: np.ndarray, wished: np.ndarray,
                 pixel: np.ndarray) -> Generator[tuple[np.ndarray, np.ndarray], None, None]:
    """Pairs of a box, from `low` to `high` (n, 2), and a place `pixel` (m, 2) with a name in common among the three
    that each has, `shown` (n, 3) and `wished` (m, 3); some of them twice, in shares that fit the memory.

    Thousands of small boxes may have one name: they and the places are told apart by cells of the picture.
    """
    first, last = _cells(low), _cells(high)
    small = (last - first <= 1).all(axis=1)
    names = np.unique(shown)
    # a large box has a cell of its own, of which every place asks as well
    large, number = CELLS * CELLS, np.arange(len(shown))
    parts = [(number[~small], np.full(np.count_nonzero(~small), large))]
    for dx, dy in ((0, 0), (0, 1), (1, 0), (1, 1)):
        other = number[small & (first + (dx, dy) <= last).all(axis=1)]
        parts.append((other, (first[other, 0] + dx) * CELLS + first[other, 1] + dy))
    box, cell = (np.concatenate(part) for part in zip(*parts))
    key = (np.searchsorted(names, shown[box]) * (large + 1) + cell[:, None]).ravel()
    order = np.argsort(key, kind="stable")
    key, box = key[order], box[order // 3]
    place, wish = np.repeat(np.arange(len(wished)), 3), np.searchsorted(names, wished.ravel())
    known = names[np.minimum(wish, len(names) - 1)] == wished.ravel()
    place, wish = place[known], wish[known]
    spot = _cells(pixel[place])
    for cell in (large, spot[:, 0] * CELLS + spot[:, 1]):
        start, stop = (np.searchsorted(key, wish * (large + 1) + cell, side=side) for side in ("left", "right"))
        before = np.append(0, np.cumsum(stop - start))
        cuts = np.searchsorted(before, np.arange(0, before[-1] + PAIRS_AT_ONCE, PAIRS_AT_ONCE))
        for begin, end in zip(cuts[:-1], cuts[1:]):
            entry, row = ranges(start[begin:end], (stop - start)[begin:end])
            yield box[entry], place[begin:end][row]


def _cells(pixel: np.ndarray) -> np.ndarray:
    """Cells (n, 2) of the picture, the outermost without an end."""
    return np.clip(np.nan_to_num(pixel) // CELL + CELLS // 2, 0, CELLS - 1).astype(np.int64)
