"""Self-occlusion: what nearer parts of the mirror hide of a camera is cut off exactly.

Hidden parts would cost work and, where the hiding part lies closer before them than reflections slide towards the eye,
come out in front of it. What one triangle hides of a camera is convex (see `contacts`). The borders of those parts that
no two hiding triangles share are outlines of the mirror, or lines in which it pierces itself; along these the camera is
cut, and of the pieces those are kept whose middle the eye sees.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cameras import Cameras
from .clipping import CONTACT, SCENE_EDGE, cut
from .contacts import hidden_sides, with_pieces
from .mirror_map import MirrorMap
from .mirror_visibility import DepthGrid
from .scene_frames import SceneFrames
from .triangle_mesh import TriangleMesh
from .vectors import cross, dot, groups, norm, ranges, rows
from .view import View

PASSES = 256  # lines that cut one camera
SMALLEST = 1e-9  # of a camera: smaller parts and pieces are nothing
SHORTEST = 1e-6  # of a line: what must lie in a piece to cut it
DEEPER = 1e-6  # of the mirror's size: how far behind a triangle's plane hidden places lie; doubled faces hide nothing


def without_occluded(view: View, mirror_map: MirrorMap, mirror: TriangleMesh, cameras: Cameras,
                     grid: DepthGrid) -> tuple[Cameras, int]:
    """Cameras without the parts that other triangles of the mirror hide; how many were cut."""
    frames = SceneFrames.of(mirror, np.unique(cameras.face))
    camera, column = _pairs_in_picture(view, cameras, frames, mirror, grid)
    camera, column, sides = _hiding(view, cameras, frames, mirror.positions, camera, column)
    if not len(camera):
        return cameras, 0
    hidden, sides, camera, column = _hidden_parts(sides, camera, column)
    lines = _outlines(view, frames, mirror.positions, hidden, sides, camera, column)
    cut_cameras = np.unique(camera)
    owner, pieces = _arrangement(cut_cameras, lines)
    parent, triangles = _seen_pieces(cut_cameras, owner, pieces, camera, sides)
    whole = np.ones(len(cameras), dtype=bool)
    whole[cut_cameras] = False
    return with_pieces(mirror_map, cameras, whole, parent, triangles)[0], len(cut_cameras)


def _pairs_in_picture(view, cameras: Cameras, frames: SceneFrames, mirror: TriangleMesh,
                      grid: DepthGrid) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of cameras and columns of other triangles whose boxes share a cell of the grid in or next to which the
    mirror lies several times over."""
    height, width = grid.layers.shape
    several = np.pad(grid.layers > 1, 1)
    several = np.logical_or.reduce([several[y:y + height, x:x + width] for y in range(3) for x in range(3)])
    if not several.any():
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    entries = []
    for corners in (cameras.places[:, cameras.corners], rows(mirror.positions[mirror.triangles[frames.triangle]])):
        flat = corners.reshape(3, -1).T
        before = (view.depths(flat) > 0.0).reshape(-1, 3).all(axis=1)
        cells = np.nan_to_num(view.pixels(flat)).reshape(-1, 3, 2) * grid.scale
        low = np.clip(np.floor(cells.min(axis=1)), 0, (width, height)).astype(np.int64)
        high = np.clip(np.floor(cells.max(axis=1)) + 1, 0, (width, height)).astype(np.int64)
        extent = np.where(before[:, None], np.maximum(high - low, 0), 0)
        y, row = ranges(low[:, 1], extent[:, 1])
        x, run = ranges(low[row, 0], extent[row, 0])
        cell, item = y[run] * width + x, row[run]
        taken = several.ravel()[cell]
        entries.append((cell[taken], item[taken]))
    (cell, camera), (other, column) = entries
    order = np.argsort(other, kind="stable")
    start, stop = (np.searchsorted(other[order], cell, side=side) for side in ("left", "right"))
    entry, run = ranges(start, stop - start)
    pairs = np.unique(camera[run] * len(frames.triangle) + column[order][entry])
    camera, column = pairs // len(frames.triangle), pairs % len(frames.triangle)
    other = cameras.face[camera] != frames.triangle[column]
    return camera[other], column[other]


def _hiding(view, cameras, frames, positions, camera, column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The pairs in which the triangle may hide a part of the camera, and its four functions; see `hidden_sides`."""
    sides, solid = hidden_sides(view, cameras, frames, positions, camera, column)
    size = np.ptp(cameras.places, axis=1).max()
    sides[3] -= DEEPER * size * norm(frames.normal)[column]
    chosen = np.flatnonzero(solid & (sides.max(axis=1) > 0.0).all(axis=0))
    camera, column, sides = camera[chosen], column[chosen], sides[:, :, chosen]
    return camera, column, sides


@dataclass(frozen=True)
class _Shapes:
    """Convex polygons (k corners in all) in the weights of cameras: as in `clipping.cut`."""

    weights: np.ndarray
    after: np.ndarray
    polygon: np.ndarray

    @classmethod
    def whole(cls, count: int) -> _Shapes:
        return cls(np.tile(np.eye(3), (1, count)), np.zeros(3 * count, dtype=np.int8), np.repeat(np.arange(count), 3))

    def cut(self, values: np.ndarray, label: int) -> _Shapes:
        return _Shapes(*cut(self.weights, self.after, self.polygon, values, label))

    def following(self) -> np.ndarray:
        """The corner after each corner."""
        following = np.arange(1, len(self.polygon) + 1)
        ends = np.flatnonzero(np.append(self.polygon[1:] != self.polygon[:-1], True)) if len(self.polygon) else []
        following[ends] = np.append(0, ends[:-1] + 1) if len(self.polygon) else []
        return following

    def areas(self, count: int) -> np.ndarray:
        """(count,): share of the camera that each polygon covers."""
        (x, y), after = self.weights[:2], self.following()
        return np.abs(np.bincount(self.polygon, x * y[after] - x[after] * y, minlength=count))

    def select(self, chosen: np.ndarray) -> _Shapes:
        """Polygons where `chosen` (count,), under new numbers."""
        kept = chosen[self.polygon]
        return _Shapes(self.weights[:, kept], self.after[kept], (np.cumsum(chosen) - 1)[self.polygon[kept]])


def _hidden_parts(sides, camera, column):
    """What each pair's triangle hides of its camera, without the pairs in which that is nothing."""
    hidden = _Shapes.whole(len(camera))
    for label, values in zip((SCENE_EDGE, SCENE_EDGE + 1, SCENE_EDGE + 2, CONTACT), sides):
        hidden = hidden.cut(values, label)
    real = hidden.areas(len(camera)) > SMALLEST
    return hidden.select(real), sides[:, :, real], camera[real], column[real]


@dataclass(frozen=True)
class _Lines:
    """Straight lines (l) across cameras: where a function, linear in the weights, is zero.

    Attributes
    ----------
    camera : (l,) int64
    values : (3, l) float64, the function at the camera's corners
    start, stop : (3, l) float64, weights of the ends of the part that bounds what is hidden
    """

    camera: np.ndarray
    values: np.ndarray
    start: np.ndarray
    stop: np.ndarray

    def select(self, chosen: np.ndarray) -> _Lines:
        return _Lines(self.camera[chosen], self.values[:, chosen], self.start[:, chosen], self.stop[:, chosen])


def _outlines(view, frames, positions, hidden: _Shapes, sides, camera, column) -> _Lines:
    """The borders of the hidden parts that no two triangles side by side share."""
    corner = np.flatnonzero(hidden.after >= SCENE_EDGE)
    pair, label = hidden.polygon[corner], hidden.after[corner].astype(np.int64) - SCENE_EDGE
    on_side = label < 3
    _, vertex = np.unique(positions, axis=0, return_inverse=True)
    vertices, own = frames.vertices[:, column[pair]], np.arange(len(pair))
    a, b, third = (vertices[(label + step) % 3, own] for step in (1, 2, 0))
    turned = vertex[a] > vertex[b]
    a, b = np.where(turned, b, a), np.where(turned, a, b)
    pa, pb, pc = (rows(positions[v]) for v in (a, b, third))
    if view.orthographic:
        across = dot(cross(pb - pa, view.forward[:, None]), pc - pa) > 0.0
    else:
        eye = view.eye[:, None]
        across = dot(cross(pa - eye, pb - eye), pc - eye) > 0.0
    first, edge = groups(camera[pair], vertex[a], vertex[b])
    both = np.ones(len(first), dtype=bool)
    for side in (across, ~across):
        both &= np.bincount(edge[on_side & side], minlength=len(first)) > 0
    outline = ~(on_side & both[edge])
    corner, pair, label = corner[outline], pair[outline], label[outline]
    return _Lines(camera[pair], sides[label, :, pair].T, hidden.weights[:, corner],
                  hidden.weights[:, hidden.following()[corner]])


def _arrangement(cameras: np.ndarray, lines: _Lines) -> tuple[np.ndarray, _Shapes]:
    """The pieces into which the lines cut the cameras, and for each its camera's place among them."""
    of_line = np.searchsorted(cameras, lines.camera)
    pieces, owner = _Shapes.whole(len(cameras)), np.arange(len(cameras))
    line, piece = np.arange(len(of_line)), of_line
    for _ in range(PASSES):
        crossing = _crosses(pieces, lines, line, piece)
        line, piece = line[crossing], piece[crossing]
        if not len(line):
            break
        order = np.argsort(piece, kind="stable")
        line, piece = line[order], piece[order]
        chosen, first = np.unique(piece, return_index=True)
        values = np.ones((3, len(owner)))
        values[:, chosen] = lines.values[:, line[first]]
        before, other = len(owner), np.full(len(owner), -1)
        other[chosen] = before + np.arange(len(chosen))
        divided = np.zeros(before, dtype=bool)
        divided[chosen] = True
        far = pieces.select(divided)
        far = far.cut(-values[:, chosen], 0)
        pieces = pieces.cut(values, 0)
        pieces = _Shapes(np.concatenate((pieces.weights, far.weights), axis=1),
                         np.concatenate((pieces.after, far.after)),
                         np.concatenate((pieces.polygon, far.polygon + before)))
        owner = np.concatenate((owner, owner[chosen]))
        rest = np.ones(len(line), dtype=bool)
        rest[first] = False
        line, piece = np.tile(line[rest], 2), np.concatenate((piece[rest], other[piece[rest]]))
    return owner, pieces


def _crosses(pieces: _Shapes, lines: _Lines, line: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Whether the lines' bounding parts run through the inside of the pieces."""
    count = np.bincount(pieces.polygon, minlength=int(piece.max(initial=0)) + 1)
    begin = np.cumsum(count) - count
    corner, asked = ranges(begin[piece], count[piece])
    number = line[asked]
    value = (pieces.weights[:, corner] * lines.values[:, number]).sum(axis=0)
    after = pieces.following()[corner]
    value_after = (pieces.weights[:, after] * lines.values[:, number]).sum(axis=0)
    crossing = np.flatnonzero((value >= 0.0) != (value_after >= 0.0))
    share = value[crossing] / (value[crossing] - value_after[crossing])
    start, end = pieces.weights[:, corner[crossing]], pieces.weights[:, after[crossing]]
    number, asked = number[crossing], asked[crossing]
    way = lines.stop[:, number] - lines.start[:, number]
    at = dot(start + share * (end - start) - lines.start[:, number], way) / np.maximum(dot(way, way), 1e-300)
    low, high = np.full(len(line), np.inf), np.full(len(line), -np.inf)
    np.minimum.at(low, asked, at)
    np.maximum.at(high, asked, at)
    return np.minimum(high, 1.0) - np.maximum(low, 0.0) > SHORTEST


def _seen_pieces(cameras, owner, pieces: _Shapes, camera, sides) -> tuple[np.ndarray, np.ndarray]:
    """The pieces that no triangle hides, as triangles: the camera each lies in and its corners' weights (3, 3, n)."""
    count = np.bincount(pieces.polygon, minlength=len(owner))
    middle = np.stack([np.bincount(pieces.polygon, weight, minlength=len(owner)) for weight in pieces.weights])
    middle /= np.maximum(count, 1)
    order = np.argsort(camera, kind="stable")
    start, stop = (np.searchsorted(camera[order], cameras[owner], side=side) for side in ("left", "right"))
    entry, piece = ranges(start, stop - start)
    functions = sides[:, :, order[entry]]
    behind = ((functions * middle[:, piece]).sum(axis=1) > 0.0).all(axis=0)
    seen = np.ones(len(owner), dtype=bool)
    seen[piece[behind]] = False
    seen &= pieces.areas(len(owner)) > SMALLEST
    owner, pieces = owner[seen], pieces.select(seen)
    size = np.bincount(pieces.polygon, minlength=len(owner))
    first = np.cumsum(size) - size
    step, fan = ranges(np.ones(len(owner), dtype=np.int64), np.maximum(size - 2, 0))
    corner = np.stack((first[fan], first[fan] + step, first[fan] + step + 1))
    weights = pieces.weights[:, corner]
    areal = np.abs(dot(weights[:, 0], cross(weights[:, 1], weights[:, 2]))) > SMALLEST
    return cameras[owner[fan[areal]]], weights[:, :, areal]
