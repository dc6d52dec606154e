"""Contacts: where the scene cuts through the mirror, the part of a camera right behind the cutting triangle is dropped.

Such a part is hidden from the eye by that very triangle, at a distance that goes to zero along the line of contact;
what it reflects would come out through the triangle once it slides towards the eye. As seen from the eye the hidden
part is convex: inside the triangle's three sides, each a plane through the eye, and behind its plane. All four are
linear in the camera's weights, so the camera without it falls into convex pieces.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..cameras import Cameras, picture_areas, with_pieces
from ..culling import Candidates
from ..geometry import SceneFrames, cross, dot, in_order, largest, ranges, rows, smallest
from ..polygons import LEAST_LEFT, ConvexPolygons, Line
from ..support import breathe, crowded

PASSES = 64  # triangles that cut one camera
AGAIN = 4  # pairs that are looked at again after cutting, to one that may be left
SHORTEST_CONTACT = 1e-6  # of the line across the camera


def drop_behind_contacts(candidates: Candidates, maximum: int,
                         again: Callable[[Cameras, tuple[np.ndarray, np.ndarray]], Candidates]
                         ) -> tuple[Candidates, np.ndarray, int, int]:
    """Candidates of cameras without the parts right behind triangles that cut through them, or at least those that
    `maximum` cameras allow.

    Parameters
    ----------
    again : callable
        The candidates among pairs of a camera and a column, asked for the pieces of cameras that were cut.

    Returns
    -------
    candidates : Candidates
    crowd : (n,) bool
        Cameras too crowded to be looked at again.
    count, left : int
        How many were cut, and how many were not cut by all that cut through them.
    """
    cameras, frames = candidates.cameras, candidates.frames
    across = (smallest(candidates.ahead) < 0.0) & (largest(candidates.ahead) > 0.0)
    pairs = np.unique(candidates.camera[across] * len(frames.triangle) + candidates.column[across])
    camera, column = pairs // len(frames.triangle), pairs % len(frames.triangle)
    origin, cut, count = np.arange(len(cameras)), np.zeros(len(cameras), dtype=bool), 0
    for number in range(PASSES + 1):
        breathe()
        meeting = np.flatnonzero(_meets(cameras, frames, camera, column))
        camera, column = camera[meeting], column[meeting]
        sides, solid = hidden_sides(cameras, frames, camera, column)
        camera, column, sides = camera[solid], column[solid], sides[:, :, solid]
        if not len(camera) or len(cameras) > maximum or number == PASSES:
            break
        chosen, first = np.unique(camera, return_index=True)
        parent, weights = _pieces(sides[:, :, first])
        count += len(chosen)
        cut[origin[chosen]] = True
        whole = np.ones(len(cameras), dtype=bool)
        whole[chosen] = False
        # what else cuts a camera is asked of its pieces
        rest = np.ones(len(camera), dtype=bool)
        rest[first] = False
        before = whole.sum()
        cameras, origin_of_piece = with_pieces(cameras, whole, chosen[parent], weights)
        origin = np.concatenate((origin[whole], origin[origin_of_piece]))
        start = np.searchsorted(camera[rest], chosen[parent])
        stop = np.searchsorted(camera[rest], chosen[parent], side="right")
        entry, piece = ranges(start, stop - start)
        camera, column = before + piece, column[rest][entry]
    left = len(np.unique(camera))
    if not count:
        return candidates, np.zeros(len(cameras), dtype=bool), 0, left
    piece = np.flatnonzero(cut[origin])
    now = np.full(len(cut), -1)
    now[np.delete(origin, piece)] = np.delete(np.arange(len(cameras)), piece)
    asked = np.flatnonzero(cut[candidates.camera])
    asked = asked[in_order(candidates.camera[asked])]
    start, stop = (np.searchsorted(candidates.camera[asked], origin[piece], side=side) for side in ("left", "right"))
    crowd = np.zeros(len(cameras), dtype=bool)
    crowd[piece] = crowded(stop - start, picture_areas(cameras.select(piece)), AGAIN * maximum)
    entry, run = ranges(start, np.where(crowd[piece], 0, stop - start))
    pairs = np.unique(piece[run] * len(frames.triangle) + candidates.column[asked[entry]])
    of_pieces = again(cameras, (pairs // len(frames.triangle), pairs % len(frames.triangle)))
    return Candidates.joined((candidates.on(cameras, now), of_pieces)), crowd, count, left


def hidden_sides(cameras: Cameras, frames: SceneFrames, camera: np.ndarray,
                 column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(4, 3, p): four functions at the cameras' corners that are positive together on the hidden part; and which
    triangles are not seen edge on, when they hide nothing."""
    view = cameras.view
    places = np.take(cameras.places, cameras.corners[camera].T, axis=1)
    vertices = rows(frames.positions[frames.vertices[:, column]])
    if view.orthographic:
        ahead = np.broadcast_to(view.forward[:, None], vertices[:, 0].shape)
        _, _, eye_side = frames.directions(column, -ahead)
    else:
        eye = view.eye[:, None]
        _, _, eye_side = frames.coordinates(column, np.broadcast_to(eye, vertices[:, 0].shape))
    functions, solid = [], np.ones(len(camera), dtype=bool)
    for j in range(3):
        third, p, q = (vertices[:, (j + k) % 3] for k in range(3))
        base = p if view.orthographic else np.broadcast_to(eye, p.shape)
        normal = cross(q - p, ahead) if view.orthographic else cross(p - base, q - base)
        inward = dot(normal, third - base)
        size = np.sqrt(dot(normal, normal) * dot(third - base, third - base))
        solid &= np.abs(inward) > 1e-9 * size
        functions.append(np.sign(inward) * dot(normal[:, None], places - base[:, None]))
    _, _, height = frames.coordinates(column, places)
    functions.append(-np.sign(eye_side) * height)
    return np.stack(functions), solid & (eye_side != 0.0)


def _meets(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Whether the triangles really cut through the cameras' triangles."""
    corners = np.take(cameras.places, cameras.corners[camera].T, axis=1)
    _, _, height = frames.coordinates(column, corners)
    size = np.abs(height).max(axis=0)
    above = height > 1e-9 * size
    below = height < -1e-9 * size
    crossing = above.any(axis=0) & below.any(axis=0)
    # the corner that is alone on its side of the plane; the line runs through the two edges from there
    alone = np.where(above.sum(axis=0) == 1, np.argmax(above, axis=0), np.argmax(below, axis=0))
    row, ends = np.arange(len(camera)), []
    for step in (1, 2):
        other = (alone + step) % 3
        gap = height[alone, row] - height[other, row]
        share = height[alone, row] / np.where(gap != 0.0, gap, 1.0)
        ends.append(corners[:, alone, row] + share * (corners[:, other, row] - corners[:, alone, row]))
    start, stop = (frames.weights(column, end) for end in ends)
    slope = stop - start
    with np.errstate(divide="ignore", invalid="ignore"):
        at = -start / slope
    low = np.where(slope > 0.0, at, np.where((slope == 0.0) & (start < 0.0), np.inf, -np.inf)).max(axis=0)
    high = np.where(slope < 0.0, at, np.inf).min(axis=0)
    return crossing & (np.minimum(high, 1.0) - np.maximum(low, 0.0) > SHORTEST_CONTACT)


def _pieces(sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cameras without their hidden parts, as triangles: which of the m cameras each lies in, and its corners' weights
    (3, 3, n), entry [i, k]: weight i of corner k."""
    rest, beside = ConvexPolygons.whole(sides.shape[2]), []
    for values in sides:
        beside.append(rest.cut(-values, Line.HIDDEN).triangles(LEAST_LEFT))
        rest = rest.cut(values, Line.HIDDEN)
    parents, triangles = zip(*beside)
    return np.concatenate(parents), np.concatenate(triangles, axis=2)
