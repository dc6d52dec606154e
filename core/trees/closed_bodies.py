"""Closed bodies: from outside nothing is seen of them from behind.

A ray that comes from outside meets a closed surface from its front first, unless it overlaps itself the wrong way. It
is closed where its oriented triangles have no border; how often it winds round a place is then a whole number, 0
outside, and nowhere less where it is turned the right way (A. Jacobson et al., "Robust inside-outside segmentation
using generalized winding numbers", SIGGRAPH 2013).
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, borders, columns, connected, cross, dot, mask, numbered, rows, solid_angles
from ..support import portions
from ..views import Covered, View
from .cones import Cones

AT_ONCE = 16384  # triangles whose arrays fit the cache
LINES = 1 << 16  # test lines through all bodies together
FEWEST, MOST = 4, 64  # test lines along each side of one body
TOGETHER = 1e-9  # share of a body's size: closer surfaces are met at once
# places in the picture, from 0 to 1, at which test rays start
STARTS = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, 3)]), axis=-1).reshape(-1, 2)
# right, up and along the lines: askew to whatever people build
FRAME = np.linalg.qr(np.array([[0.83, -0.46, 0.31], [0.37, 0.71, 0.59], [-0.41, -0.53, 0.74]]))[0]


@dataclass(frozen=True)
class ClosedBodies:
    """Closed bodies (k) among the triangles (m) of a mesh.

    Attributes
    ----------
    mesh : TriangleMesh
    border : (b,) int64, vertices at which the surface ends, or changes its orientation
    part : (v,) int64, connected part of the mesh that each vertex belongs to; vertices in one place are connected
    body : (m,) int64, the body that each triangle bounds, -1 for none
    outward : (m,) float64, 1 for triangles whose normal points out of the body that they bound, 0 for all others
    low, high : (3, k) float64, bounding boxes of the bodies along the directions of `FRAME`
    """

    mesh: TriangleMesh
    border: np.ndarray
    part: np.ndarray
    body: np.ndarray
    outward: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @classmethod
    def of(cls, mesh: TriangleMesh) -> ClosedBodies:
        """Find the closed bodies of a mesh that is in its canonical order."""
        triangles = mesh.triangles
        places = mesh.places[triangles]
        ends = borders(places, len(mesh.positions))[mesh.places]
        border = np.flatnonzero(ends)
        part = connected(places)
        closed = ~mask(int(part.max(initial=-1)) + 1, part[ends[triangles].any(axis=1)])
        number = numbered(len(closed), closed)
        body = number[part] if len(part) else part
        part_of = np.zeros(len(mesh.positions), dtype=np.int64)
        part_of[triangles.ravel()] = np.repeat(part, 3)
        some = np.flatnonzero(body >= 0)
        low, high = (np.full((3, int(closed.sum())), end) for end in (np.inf, -np.inf))
        outward = np.zeros(len(triangles))
        if not len(some):
            return cls(mesh, border, part_of, body, outward, low, high)
        spots = FRAME @ rows(mesh.positions)
        owner = np.full(len(mesh.positions), -1)
        owner[triangles[some].ravel()] = np.repeat(body[some], 3)
        used = np.flatnonzero(owner >= 0)
        for axis in range(3):
            np.minimum.at(low[axis], owner[used], spots[axis, used])
            np.maximum.at(high[axis], owner[used], spots[axis, used])
        own, corner = body[some], triangles[some].T
        facing, volume = _up_and_volume(spots, corner, 0.5 * (low + high), own)
        # a room has its front inside, a negative volume: from outside one looks into it through its back faces
        proper = np.bincount(own, volume, minlength=low.shape[1]) > 0.0
        proper &= ~_overlapping(spots, corner, own, facing, (low, high))
        outward[some[proper[own]]] = 1.0
        return cls(mesh, border, part_of, body, outward, low, high)

    def outward_from(self, view: View) -> np.ndarray:
        """Return `outward` (m,) for triangles of bodies that the view is outside of, and 0 for all others.

        Mirrors show such a body from outside too, since no surface lies between the eye and the mirror. The view looks
        from its near clipping plane: a camera in front of a room may thus look into it. It also looks from the eye,
        because mirrors are seen from there.
        """
        if not self.low.shape[1]:
            return self.outward
        starts = view.starts(STARTS * view.resolution)
        if not view.orthographic:
            starts = np.concatenate((starts, view.eye[None]))
        spots, ahead = FRAME @ starts.T, FRAME @ view.forward
        outside = ((spots.max(axis=1)[:, None] < self.low) | (spots.min(axis=1)[:, None] > self.high)).any(axis=0)
        # the start points of a picture lie in one plane: bodies on one side of it are outside
        height = ahead @ (0.5 * (self.low + self.high)) - (ahead @ spots)[:, None]
        room = (1.0 + TOGETHER) * (np.abs(ahead) @ (0.5 * (self.high - self.low)))
        outside |= (height > room).all(axis=0) | (height < -room).all(axis=0)
        # test winding numbers only in perspective: an orthographic view may start in a body between its start points
        for body in np.flatnonzero(~outside) if not view.orthographic else ():
            corners = self.mesh.positions[self.mesh.triangles[self.body == body]]
            outside[body] = all(abs(solid_angles(start, corners).sum()) < 2.0 * np.pi for start in starts)
        return np.where((self.body >= 0) & np.append(outside, False)[self.body], self.outward, 0.0)

    def having(self, some: np.ndarray) -> np.ndarray:
        """Return True for triangles (m,) of bodies that some of the triangles, `some` (m,), bound."""
        bodies = mask(self.low.shape[1] + 1, self.body[some])  # the last entry is for triangles that bound no body
        return (self.body >= 0) & bodies[self.body]


@dataclass(frozen=True)
class Fronts:
    """Half-spaces from which triangles (m) can be seen.

    Attributes
    ----------
    plane : (4, m) float64
        Unit normal on the visible side of a triangle, and its height along that; zero if both sides are visible.
    """

    plane: np.ndarray

    @classmethod
    def of(cls, mesh: TriangleMesh, outward: np.ndarray) -> Fronts:
        """Return the half-spaces in front of triangles with `outward` (m,) 1; triangles with 0 are seen from both."""
        normal = rows(mesh.face_normals()) * outward
        return cls(np.concatenate((normal, dot(normal, rows(mesh.positions[mesh.triangles[:, 0]]))[None])))

    def may_show(self, cones: Cones, cone: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        """Return True (p,) if rays of each cone `cone` (p,) may start where its `triangle` (p,) can be seen."""
        normal = columns(self.plane, triangle)
        height = dot(normal, columns(cones.centre, cone))
        height -= normal[3]
        return height >= -(1.0 + TOGETHER) * columns(cones.radius, cone)


def _up_and_volume(spots: np.ndarray, corner: np.ndarray, middle: np.ndarray,
                   body: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the orientation of triangles, and their contributions to their bodies' volumes.

    Parameters
    ----------
    spots : (3, v) float64, vertices in the directions of `FRAME`
    corner : (3, n) int64, vertices of the triangles
    middle : (3, k) float64, centres of the bodies
    body : (n,) int64, of each triangle

    Returns
    -------
    facing : (n,) float64, 1 for triangles that face up, -1 for those that face down
    volume : (n,) float64, six times the signed volume of the tetrahedron from the body's centre
    """
    facing, volume = np.empty(len(body)), np.empty(len(body))
    for part in portions(len(body), AT_ONCE):
        a, b, c = (columns(spots, of_all) for of_all in corner[:, part])
        normal = cross(b - a, c - a)
        facing[part] = np.sign(normal[2])
        volume[part] = dot(normal, a - columns(middle, body[part]))
    return facing, volume


def _overlapping(spots: np.ndarray, corner: np.ndarray, body: np.ndarray, facing: np.ndarray,
                 boxes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Return True for bodies (k,) that some vertical line from above leaves before it has entered them.

    A line enters a body at triangles that face up, and leaves it at triangles that face down.

    Parameters
    ----------
    spots : (3, v) float64, vertices in the directions of `FRAME`
    corner : (3, n) int64, vertices of the triangles
    body : (n,) int64, of each triangle
    facing : (n,) float64, 1 for triangles that face up, -1 for those that face down
    boxes : two (3, k) float64, low and high corners of the bodies' boxes
    """
    low, high = boxes
    count = low.shape[1]
    side = int(np.clip(np.sqrt(LINES / count), FEWEST, MOST))
    across = int(np.ceil(np.sqrt(count)))
    size = np.where(high[:2] > low[:2], high[:2] - low[:2], 1.0)
    tile = np.stack((np.arange(count) % across, np.arange(count) // across))
    own, pixel, depth, sign = [], [], [], []
    for part in portions(len(body), AT_ONCE):
        of_body = body[part]
        ends = columns(spots, corner[:, part])
        seen = ((ends[:2] - columns(low[:2], of_body)[:, None]) / columns(size, of_body)[:, None]
                + columns(tile, of_body)[:, None]) * side
        covered = Covered.of(seen, ends[2], (across * side, across * side), False)
        own.append(of_body[covered.face])
        sign.append(facing[part][covered.face])
        pixel.append(covered.pixel)
        depth.append(covered.order)
    owner, entering, line, height = (np.concatenate(parts) for parts in (own, sign, pixel, depth))
    order = np.lexsort((-height - entering * TOGETHER * (high[2] - low[2])[owner], line))
    entering, line = entering[order], line[order]
    inside = np.cumsum(entering)
    first = np.flatnonzero(np.diff(line, prepend=-1))
    inside -= np.repeat(inside[first] - entering[first], np.diff(np.append(first, len(line))))
    last = np.append(first, len(line))[1:] - 1
    wrong = inside < 0.0
    wrong[last] |= inside[last] != 0.0
    return mask(count, owner[order[wrong]])
