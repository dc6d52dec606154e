"""Parts of cameras that triangles hide from the eye, and removal of these parts.

As seen from the eye the part that a triangle hides is convex: it lies inside the triangle's three sides, each a plane
through the eye, and behind the triangle's plane. Of a triangle that reaches behind the plane of an orthographic eye,
only the part before that plane hides anything. All these functions are linear in the camera's weights. The borders of
such parts that no two adjacent triangles share are outlines of the occluders, or lines in which they meet the mirror. A
camera is cut along these, and the pieces are kept whose centre the eye sees.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, with_pieces
from ..geometry import (
    ColumnArrays,
    SceneFrames,
    between,
    columns,
    cross,
    distinct,
    dot,
    groups,
    in_order,
    norm,
    others,
    ranges,
    rows,
    shares,
)
from ..polygons import SMALLEST, ConvexPolygons, Line, Lines, divide
from .picture_pairs import PAIRS_AT_ONCE

DEEPER = 1e-6  # share of the mirror's size: least depth of hidden places behind a triangle; doubled faces hide nothing
FLAT = 1e-9  # sine of a triangle's angle to the view, or of its own angle: flatter triangles hide nothing
MOST_HIDING = 1 << 18  # pairs of a camera and a triangle that hides a part of it; cameras with the most stay whole


@dataclass(frozen=True)
class HiddenParts(ColumnArrays):
    """Parts (q) of cameras that triangles hide.

    Attributes
    ----------
    parts : ConvexPolygons
    sides : (4 or 5, 3, q) float64
        Functions at the cameras' corners that are positive together on the part: of the triangle's sides, of its plane,
        and in orthographic views of the eye's.
    eye : (q,) float64
        How far the eye is from the plane, in the units of the last function; in orthographic views, how fast one
        comes nearer to the plane on the way to the eye.
    camera, column : (q,) int64, the triangle's column in the frames
    """

    parts: ConvexPolygons
    sides: np.ndarray
    eye: np.ndarray
    camera: np.ndarray
    column: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray,
           deeper: np.ndarray | float) -> HiddenParts:
        """Compute the hidden parts in pairs of a `camera` (p,) and a triangle `column` (p,) of the frames.

        Only places more than `deeper` scene units behind the triangle's plane are hidden: one number for each pair
        (p,) or for all. Pairs without a hidden part are dropped.
        """
        sides, eye, solid = _sides(cameras, frames, camera, column)
        sides[3] -= deeper * norm(frames.normal)[column]
        chosen = np.flatnonzero(solid & (sides.max(axis=1) > 0.0).all(axis=0))
        sides, parts = sides[:, :, chosen], ConvexPolygons.whole(len(chosen))
        for label, values in zip(range(Line.SCENE_EDGE, Line.HIDDEN + 1), sides):
            parts = parts.cut(values, label)
        return cls(parts, sides, eye[chosen], camera[chosen], column[chosen]).select(parts.areas > SMALLEST)

    @property
    def entire(self) -> np.ndarray:
        """True (q,) for parts that cover their whole camera."""
        return self.parts.areas > 1.0 - SMALLEST

    def nearest(self, orthographic: bool) -> np.ndarray:
        """Return the least depth (q,) of each part behind its triangle's plane.

        It is a share of the distance to the eye, or in `orthographic` views in scene units.
        """
        depth = (self.parts.weights * self.sides[3][:, self.parts.polygon]).sum(axis=0)
        least = np.maximum(np.minimum.reduceat(depth, self.parts.start[:-1]), 0.0)
        return least / (self.eye if orthographic else least + self.eye)

    def outlines(self, view, frames: SceneFrames) -> Lines:
        """Return the borders of the parts that no two adjacent triangles share, in each camera."""
        corner = np.flatnonzero(self.parts.after >= Line.SCENE_EDGE)
        pair, label = self.parts.polygon[corner], self.parts.after[corner].astype(np.int64) - Line.SCENE_EDGE
        on_side, own = label < 3, np.arange(len(pair))
        place, point = _places(frames, self.column[pair])
        a, b, third = (place[corner % 3, own] for corner in (*others(label), label))
        turned = a > b
        a, b = np.where(turned, b, a), np.where(turned, a, b)
        pa, pb, pc = (point[:, some] for some in (a, b, third))
        if view.orthographic:
            across = dot(cross(pb - pa, view.forward[:, None]), pc - pa) > 0.0
        else:
            eye = view.eye[:, None]
            across = dot(cross(pa - eye, pb - eye), pc - eye) > 0.0
        first, edge = groups(self.camera[pair], a, b)
        both = np.ones(len(first), dtype=bool)
        for side in (across, ~across):
            both &= np.bincount(edge[on_side & side], minlength=len(first)) > 0
        outline = ~(on_side & both[edge])
        corner, pair, label = corner[outline], pair[outline], label[outline]
        return Lines(self.camera[pair], self.sides[label, :, pair].T, self.parts.weights[:, corner],
                     self.parts.weights[:, self.parts.following[corner]])

    def cut_off(self, cameras: Cameras, shown: np.ndarray, lines: Lines,
                most: int) -> tuple[Cameras, np.ndarray, np.ndarray, int]:
        """Remove these parts from the `cameras` (n): cut them along `lines` into about `most` pieces, keep the visible.

        Parameters
        ----------
        shown : (n,) bool, False for cameras that are hidden entirely

        Returns
        -------
        cameras : Cameras, those that were not cut, then the pieces (p)
        cut : (c,) int64, cameras that were cut
        parent : (p,) int64, camera that each piece is a part of
        left : int, number of cameras that were not cut along all their lines
        """
        cut, pieces_of = np.unique(self.camera), np.zeros(0, dtype=np.int64)
        if not len(cut):
            return cameras.select(shown), cut, pieces_of, 0
        pieces, left = divide(ConvexPolygons.whole(len(cut)), lines, np.arange(len(lines.camera)),
                              np.searchsorted(cut, lines.camera), most)
        parent, triangles = self._seen(cut, pieces)
        whole = shown.copy()
        whole[cut] = False
        return with_pieces(cameras, whole, parent, triangles), cut, parent, len(left)

    def _seen(self, cut: np.ndarray, pieces: ConvexPolygons) -> tuple[np.ndarray, np.ndarray]:
        """Return the `pieces` of the cameras `cut` (c,) that no triangle hides, as triangles.

        Returns
        -------
        parent : (n,) int64, camera that each triangle lies in
        weights : (3, 3, n) float64, weights of its corners there, entry [i, k]: weight i of corner k
        """
        middle, order = pieces.middles, in_order(self.camera)
        start, count = between(self.camera[order], cut[pieces.owner], cut[pieces.owner])
        seen = np.ones(len(pieces), dtype=bool)
        for part in shares(count, PAIRS_AT_ONCE):
            entry, piece = ranges(start[part], count[part])
            piece += part.start
            hiding = columns(order, entry)
            # the first side or two decide most pairs
            for side in self.sides:
                behind = np.flatnonzero(dot(columns(side, hiding), columns(middle, piece)) > 0.0)
                hiding, piece = hiding[behind], piece[behind]
            seen[piece] = False
        seen &= pieces.areas > SMALLEST
        parent, weights = pieces.select(seen).triangles()
        return cut[parent], weights


def _places(frames: SceneFrames, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number the distinct places of the corners of triangles `column` (n,).

    Returns
    -------
    number : (3, n) int64, index of each corner's place; corners in one place share it
    place : (3, k) float64
    """
    vertex, number = distinct(frames.vertices[:, column].ravel())
    place, same = np.unique(frames.positions[vertex], axis=0, return_inverse=True)
    return same.reshape(-1)[number].reshape(3, -1), rows(place)


def _sides(cameras: Cameras, frames: SceneFrames, camera: np.ndarray,
           column: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute `HiddenParts.sides` and `HiddenParts.eye` of pairs of a `camera` (p,) and a triangle `column` (p,).

    Returns
    -------
    sides : (4 or 5, 3, p) float64
    eye : (p,) float64
    solid : (p,) bool, False for triangles that are seen edge on, which hide nothing
    """
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
        solid &= np.abs(inward) > FLAT * size
        functions.append(np.sign(inward) * dot(normal[:, None], places - base[:, None]))
    _, _, height = frames.coordinates(column, places)
    functions.append(-np.sign(eye_side) * height)
    if view.orthographic:
        depths = [view.depths(some.reshape(3, -1).T).reshape(some.shape[1:]) for some in (places, vertices)]
        with np.errstate(divide="ignore", invalid="ignore"):
            hiding = depths[0] + height / eye_side
        functions.append(np.where((depths[1] >= 0.0).all(axis=0) | (eye_side == 0.0), 1.0, hiding))
    return np.stack(functions), np.abs(eye_side), solid & (eye_side != 0.0)
