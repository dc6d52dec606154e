"""Self-occlusion: what nearer parts of the mirror hide of a camera is cut off exactly.

Hidden parts would cost work and, where the hiding part lies closer before them than reflections slide towards the eye,
come out in front of it. What one triangle hides of a camera is convex (see `contacts`). The borders of those parts that
no two hiding triangles share are outlines of the mirror, or lines in which it pierces itself; along these the camera is
cut, and of the pieces those are kept whose middle the eye sees.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .clipping import CONTACT, SCENE_EDGE
from .contacts import hidden_sides, with_pieces
from .convex_parts import SMALLEST, ConvexParts, Lines, divide
from .mirror_map import MirrorMap
from .mirror_visibility import DepthGrid
from .scene_frames import SceneFrames
from .triangle_mesh import TriangleMesh
from .vectors import cross, dot, groups, norm, ranges, rows
from .view import View

PAIRS_AT_ONCE = 1 << 20
DEEPER = 1e-6  # of the mirror's size: how far behind a triangle's plane hidden places lie; doubled faces hide nothing


def without_occluded(view: View, mirror_map: MirrorMap, mirror: TriangleMesh, cameras: Cameras,
                     grid: DepthGrid) -> tuple[Cameras, int]:
    """Cameras without the parts that other triangles of the mirror hide; how many were cut."""
    frames = SceneFrames.of(mirror, np.unique(cameras.face))
    camera, column = _pairs_in_picture(view, cameras, frames, mirror, grid)
    camera, column, sides = _hiding(view, cameras, frames, mirror.positions, camera, column)
    hidden, sides, camera, column = _hidden_parts(sides, camera, column)
    if not len(camera):
        return cameras, 0
    lines = _outlines(view, frames, mirror.positions, hidden, sides, camera, column)
    cut_cameras = np.unique(camera)
    owner, pieces = divide(cut_cameras, lines)
    parent, triangles = _seen_pieces(cut_cameras, owner, pieces, camera, sides)
    whole = np.ones(len(cameras), dtype=bool)
    whole[cut_cameras] = False
    return with_pieces(mirror_map, cameras, whole, parent, triangles)[0], len(cut_cameras)


def _pairs_in_picture(view: View, cameras: Cameras, frames: SceneFrames, mirror: TriangleMesh,
                      grid: DepthGrid) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of cameras and columns of other triangles whose boxes in the picture overlap where the mirror lies several
    times over, by the cells of the grid."""
    height, width = grid.layers.shape
    several = np.pad(grid.layers > 1, 1)
    several = np.logical_or.reduce([several[y:y + height, x:x + width] for y in range(3) for x in range(3)])
    pairs = np.zeros(0, dtype=np.int64)
    if not several.any():
        return pairs, pairs
    (low, high, cell, camera), (other_low, other_high, other_cell, column) = (
        _cells(view, corners, several, grid.scale) for corners in
        (cameras.places[:, cameras.corners], rows(mirror.positions[mirror.triangles[frames.triangle]])))
    order = np.argsort(other_cell, kind="stable")
    column = column[order]
    start, stop = (np.searchsorted(other_cell[order], cell, side=side) for side in ("left", "right"))
    before = np.append(0, np.cumsum(stop - start))
    cuts = np.searchsorted(before, np.arange(0, before[-1] + PAIRS_AT_ONCE, PAIRS_AT_ONCE))
    for first, last in zip(cuts[:-1], cuts[1:]):
        entry, run = ranges(start[first:last], (stop - start)[first:last])
        near, far = camera[first:last][run], column[entry]
        meet = ((low[near] < other_high[far]) & (other_low[far] < high[near])).all(axis=1)
        meet &= cameras.face[near] != frames.triangle[far]
        pairs = np.union1d(pairs, near[meet] * len(frames.triangle) + far[meet])
    return pairs // len(frames.triangle), pairs % len(frames.triangle)


def _cells(view: View, corners: np.ndarray, several: np.ndarray, scale: float) -> tuple:
    """Boxes `low` and `high` (n, 2) of triangles (3, n, 3) before the eye, in cells; the cells of `several` that they
    touch, and for each of these the triangle."""
    height, width = several.shape
    flat = corners.reshape(3, -1).T
    before = (view.depths(flat) > 0.0).reshape(-1, 3).all(axis=1)
    pixels = np.nan_to_num(view.pixels(flat)).reshape(-1, 3, 2) * scale
    low, high = pixels.min(axis=1), pixels.max(axis=1)
    first = np.clip(np.floor(low), 0, (width, height)).astype(np.int64)
    extent = np.clip(np.floor(high) + 1, 0, (width, height)).astype(np.int64) - first
    y, row = ranges(first[:, 1], np.where(before, np.maximum(extent[:, 1], 0), 0))
    x, run = ranges(first[row, 0], np.maximum(extent[row, 0], 0))
    cell, triangle = y[run] * width + x, row[run]
    taken = several.ravel()[cell]
    return low, high, cell[taken], triangle[taken]


def _hiding(view, cameras, frames, positions, camera, column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The pairs in which the triangle may hide a part of the camera, and its four functions; see `hidden_sides`."""
    sides, solid = hidden_sides(view, cameras, frames, positions, camera, column)
    size = np.ptp(cameras.places, axis=1).max()
    sides[3] -= DEEPER * size * norm(frames.normal)[column]
    chosen = np.flatnonzero(solid & (sides.max(axis=1) > 0.0).all(axis=0))
    camera, column, sides = camera[chosen], column[chosen], sides[:, :, chosen]
    return camera, column, sides


def _hidden_parts(sides, camera, column):
    """What each pair's triangle hides of its camera, without the pairs in which that is nothing."""
    hidden = ConvexParts.whole(len(camera))
    for label, values in zip((SCENE_EDGE, SCENE_EDGE + 1, SCENE_EDGE + 2, CONTACT), sides):
        hidden = hidden.cut(values, label)
    real = hidden.areas(len(camera)) > SMALLEST
    return hidden.select(real), sides[:, :, real], camera[real], column[real]


def _outlines(view, frames, positions, hidden: ConvexParts, sides, camera, column) -> Lines:
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
    return Lines(camera[pair], sides[label, :, pair].T, hidden.weights[:, corner],
                  hidden.weights[:, hidden.following()[corner]])


def _seen_pieces(cameras, owner, pieces: ConvexParts, camera, sides) -> tuple[np.ndarray, np.ndarray]:
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
    piece, weights = pieces.select(seen).triangles(int(seen.sum()))
    return cameras[owner[seen][piece]], weights
