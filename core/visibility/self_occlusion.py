"""Self-occlusion: what nearer parts of the mirror hide of a camera is cut off exactly.

Hidden parts would cost work and, where the hiding part lies closer before them than reflections slide towards the eye,
come out in front of it. What one triangle hides of a camera is convex (see `scene_contacts`). The borders of those
parts that no two hiding triangles share are outlines of the mirror, or lines in which it pierces itself; along these
the camera is cut, and of the pieces those are kept whose middle the eye sees.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, picture_areas, with_pieces
from ..geometry import SceneFrames, TriangleMesh, cross, dot, groups, in_order, norm, others, ranges, rows, shares
from ..polygons import SMALLEST, ConvexPolygons, Line, Lines, divide
from ..support import breathe, crowded
from .eye_plane import triangles_before_eye
from .mirror_visibility import DepthGrid
from .picture_pairs import pairs_in_picture
from .scene_contacts import hidden_sides

PAIRS_AT_ONCE = 1 << 17
MOST_PIECES = 1 << 18  # as many as cameras are cut into altogether
MOST_HIDING = 1 << 18  # pairs of a camera and a triangle that hides a part of it; cameras with the most stay whole
MOST_WORK = 1 << 23  # lines of cameras, each once for every triangle that hides a part of its camera
DEEPER = 1e-6  # of the mirror's size: how far behind a triangle's plane hidden places lie; doubled faces hide nothing


def without_occluded(mirror: TriangleMesh, cameras: Cameras, grid: DepthGrid) -> tuple[Cameras, int, int]:
    """Cameras without the parts that other triangles of the mirror hide; how many were cut, and how many were not, or
    not along all outlines, since too much of the mirror lies over them."""
    view = cameras.view
    mirror, owner = triangles_before_eye(view, mirror, np.unique(cameras.face))
    frames = SceneFrames.of(mirror, np.arange(len(owner)))
    shown = np.ones(len(cameras), dtype=bool)
    parts = []
    pairs = pairs_in_picture(cameras, mirror, owner, grid, PAIRS_AT_ONCE)
    if pairs is None:
        return cameras, 0, len(cameras)
    for camera, column in pairs:
        breathe()
        parts.append(_hidden_parts(*_hiding(cameras, frames, camera, column), shown))
    if not parts:
        return cameras, 0, 0
    count, worth = np.zeros(len(cameras), dtype=np.int64), picture_areas(cameras)
    for part in parts:
        count += np.bincount(part[2], minlength=len(cameras))
    uncut = crowded(np.where(shown, count, 0), worth, MOST_HIDING)
    hidden, sides, camera, column = _joined(parts, shown & ~uncut)
    lines = _outlines(view, (frames, mirror.place_of), hidden, sides, camera, column)
    # each piece that the lines leave is asked of each triangle that hides a part of its camera
    load = np.bincount(lines.camera, minlength=len(cameras)) * count
    uncut |= crowded(load, worth, MOST_WORK)
    lines, kept = lines.select(~uncut[lines.camera]), ~uncut[camera]
    cut, left = _cut(cameras, shown, lines, camera[kept], sides[:, :, kept])
    return cut, int((count > 0).sum() - uncut.sum()), int(uncut.sum()) + left


def _cut(cameras: Cameras, shown: np.ndarray, lines: Lines, camera: np.ndarray,
         sides: np.ndarray) -> tuple[Cameras, int]:
    """The cameras that are `shown` (n,), those of the pairs `camera` (p,), of which triangles hide what their `sides`
    (4, 3, p) bound, without what is hidden; and how many are not cut along all lines."""
    if not len(camera):
        return cameras.select(shown), 0
    cut_cameras, whole = np.unique(camera), shown.copy()
    pieces, left = divide(ConvexPolygons.whole(len(cut_cameras)), lines, np.arange(len(lines.camera)),
                          np.searchsorted(cut_cameras, lines.camera), MOST_PIECES)
    parent, triangles = _seen_pieces(cut_cameras, pieces, camera, sides)
    whole[cut_cameras] = False
    return with_pieces(cameras, whole, parent, triangles)[0], len(left)


def _joined(parts: list, kept: np.ndarray):
    """The hidden parts of the cameras `kept` (n,), joined."""
    chosen = [kept[part[2]] for part in parts]
    hidden = ConvexPolygons.joined([part[0].select(own) for part, own in zip(parts, chosen)])
    sides, camera, column = (np.concatenate([part[k][..., own] for part, own in zip(parts, chosen)], axis=-1)
                             for k in (1, 2, 3))
    return hidden, sides, camera, column


def _hiding(cameras, frames, camera, column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The pairs in which the triangle may hide a part of the camera, behind its four functions; see `hidden_sides`."""
    sides, solid = hidden_sides(cameras, frames, camera, column)
    size = np.ptp(cameras.places, axis=1).max()
    sides[3] -= DEEPER * size * norm(frames.normal)[column]
    chosen = np.flatnonzero(solid & (sides.max(axis=1) > 0.0).all(axis=0))
    camera, column, sides = camera[chosen], column[chosen], sides[:, :, chosen]
    return sides, camera, column


def _hidden_parts(sides, camera, column, shown):
    """What each pair's triangle hides of its camera, without the pairs in which that is nothing; takes the cameras of
    which one triangle hides all from those `shown` (n,)."""
    hidden = ConvexPolygons.whole(len(camera))
    for label, values in zip(range(Line.SCENE_EDGE, Line.CONTACT + 1), sides):
        hidden = hidden.cut(values, label)
    area = hidden.areas
    real = area > SMALLEST
    shown[camera[area > 1.0 - SMALLEST]] = False
    real &= shown[camera]
    return hidden.select(real), sides[:, :, real], camera[real], column[real]


def _outlines(view, placed, hidden: ConvexPolygons, sides, camera, column) -> Lines:
    """The borders of the hidden parts that no two triangles side by side share; `placed` are the
    triangles' frames, and the number of each vertex's place."""
    corner = np.flatnonzero(hidden.after >= Line.SCENE_EDGE)
    pair, label = hidden.polygon[corner], hidden.after[corner].astype(np.int64) - Line.SCENE_EDGE
    on_side, (frames, vertex) = label < 3, placed
    vertices, own = frames.vertices[:, column[pair]], np.arange(len(pair))
    a, b, third = (vertices[corner % 3, own] for corner in (*others(label), label))
    turned = vertex[a] > vertex[b]
    a, b = np.where(turned, b, a), np.where(turned, a, b)
    pa, pb, pc = (rows(frames.positions[v]) for v in (a, b, third))
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
                  hidden.weights[:, hidden.following[corner]])


def _seen_pieces(cameras, pieces: ConvexPolygons, camera, sides) -> tuple[np.ndarray, np.ndarray]:
    """The pieces that no triangle hides, as triangles: the camera each lies in and its corners' weights (3, 3, n)."""
    middle = pieces.middles
    order = in_order(camera)
    start, stop = (np.searchsorted(camera[order], cameras[pieces.owner], side=side) for side in ("left", "right"))
    seen = np.ones(len(pieces), dtype=bool)
    for part in shares(stop - start, PAIRS_AT_ONCE):
        breathe()
        entry, piece = ranges(start[part], (stop - start)[part])
        piece += part.start
        behind = ((sides[:, :, order[entry]] * middle[:, piece]).sum(axis=1) > 0.0).all(axis=0)
        seen[piece[behind]] = False
    seen &= pieces.areas > SMALLEST
    parent, weights = pieces.select(seen).triangles()
    return cameras[parent], weights
