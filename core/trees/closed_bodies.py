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

AT_ONCE = 16384  # triangles: what their arrays take fits the cache
LINES = 1 << 16  # that bodies are looked through along, all together
FEWEST, MOST = 4, 64  # of them along each side of one body
TOGETHER = 1e-9  # of a body's size: what lies closer is met at once
STARTS = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, 3)]), axis=-1).reshape(-1, 2)  # of rays, over the picture
# right, up and along the lines: askew to whatever people build
FRAME = np.linalg.qr(np.array([[0.83, -0.46, 0.31], [0.37, 0.71, 0.59], [-0.41, -0.53, 0.74]]))[0]


@dataclass(frozen=True)
class ClosedBodies:
    """Closed bodies (k) among the triangles (m) of a mesh.

    Attributes
    ----------
    mesh : TriangleMesh
    border : (v,) int64, vertices at which the surface ends, or turns its other side
    part : (v,) int64, the part of the mesh that each vertex is of: what hangs together by vertices in one place
    body : (m,) int64, the body that each triangle bounds, -1 for none
    outward : (m,) float64, 1 where its normal points out of the body that it bounds, 0 where it bounds none
    low, high : (3, k) float64, the boxes round the bodies along the directions of `FRAME`
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
        """Those of a mesh in its canonical order."""
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
        # a room has its front within: who looks into it from outside does so through what is culled there
        proper = np.bincount(own, volume, minlength=low.shape[1]) > 0.0
        proper &= ~_overlapping(spots, corner, own, facing, (low, high))
        outward[some[proper[own]]] = 1.0
        return cls(mesh, border, part_of, body, outward, low, high)

    def outward_from(self, view: View) -> np.ndarray:
        """What `outward` (m,) is of bodies from outside of which the view looks, 0 of all others: what it sees in
        mirrors it sees from outside as well, since on the way there nothing is in between. It looks from where it
        does not cut off any more what is near: a camera that stands before a room may so look into it; and from the
        eye, from which on mirrors are met."""
        if not self.low.shape[1]:
            return self.outward
        starts = view.starts(STARTS * view.resolution)
        if not view.orthographic:
            starts = np.concatenate((starts, view.eye[None]))
        spots, ahead = FRAME @ starts.T, FRAME @ view.forward
        outside = ((spots.max(axis=1)[:, None] < self.low) | (spots.min(axis=1)[:, None] > self.high)).any(axis=0)
        # those of a picture lie in one plane
        height = ahead @ (0.5 * (self.low + self.high)) - (ahead @ spots)[:, None]
        room = (1.0 + TOGETHER) * (np.abs(ahead) @ (0.5 * (self.high - self.low)))
        outside |= (height > room).all(axis=0) | (height < -room).all(axis=0)
        # where an orthographic view starts it cuts bodies between its points as well
        for body in np.flatnonzero(~outside) if not view.orthographic else ():
            corners = self.mesh.positions[self.mesh.triangles[self.body == body]]
            outside[body] = all(abs(solid_angles(start, corners).sum()) < 2.0 * np.pi for start in starts)
        return np.where((self.body >= 0) & np.append(outside, False)[self.body], self.outward, 0.0)

    def having(self, some: np.ndarray) -> np.ndarray:
        """Return True for triangles (m,) of bodies that some of the triangles, `some` (m,), bound."""
        bodies = mask(self.low.shape[1] + 1, self.body[some])  # the last one for what bounds none
        return (self.body >= 0) & bodies[self.body]


@dataclass(frozen=True)
class Fronts:
    """From where triangles (m) can be seen.

    Attributes
    ----------
    plane : (4, m) float64
        Unit normal to the side that a triangle shows, and how high it lies along it; zero where it shows both.
    """

    plane: np.ndarray

    @classmethod
    def of(cls, mesh: TriangleMesh, outward: np.ndarray) -> Fronts:
        """Those of a mesh that shows its outer side, where that is told (m,)."""
        normal = rows(mesh.face_normals()) * outward
        return cls(np.concatenate((normal, dot(normal, rows(mesh.positions[mesh.triangles[:, 0]]))[None])))

    def may_show(self, cones: Cones, cone: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        """Whether rays of the cones (p,) may come from where the triangles (p,) can be seen."""
        normal = columns(self.plane, triangle)
        height = dot(normal, columns(cones.centre, cone))
        height -= normal[3]
        return height >= -(1.0 + TOGETHER) * columns(cones.radius, cone)


def _up_and_volume(spots: np.ndarray, corner: np.ndarray, middle: np.ndarray,
                   body: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of triangles with `corner` (3, n) among spots (3, v): 1 where they face up, -1 down; and six times their cones'
    volumes from the middles (3, k) of their bodies (n,)."""
    facing, volume = np.empty(len(body)), np.empty(len(body))
    for part in portions(len(body), AT_ONCE):
        a, b, c = (columns(spots, of_all) for of_all in corner[:, part])
        normal = cross(b - a, c - a)
        facing[part] = np.sign(normal[2])
        volume[part] = dot(normal, a - columns(middle, body[part]))
    return facing, volume


def _overlapping(spots: np.ndarray, corner: np.ndarray, body: np.ndarray, facing: np.ndarray,
                 boxes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Bodies (k,) that some line from above leaves before it has entered them: it enters those of triangles with
    `corner` (3, n) among spots (3, v) where these are `facing` (n,) up, and leaves where down."""
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
