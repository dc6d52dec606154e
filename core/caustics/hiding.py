"""Selection of possible occluders: triangles whose plane has ray starts on one side and ray ends on the other.

In an empty room with a flat floor no triangle can occlude anything. Leaving such triangles out saves ray tests.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, ranges, shares, spread_directions
from ..trees import along_curve
from .lamps import Lamp

ABOVE = 1e-7  # share of the scene's size: points closer to a plane count as lying in it
PLANES = 1e-6  # components of a unit normal, and share of the scene's size: planes that differ by less are merged
AT_ONCE, FEW_AT_ONCE = 1 << 22, 1 << 18
WAYS = 200  # directions in which the outermost corners of a mesh are searched
TOGETHER = 32  # neighbouring corners in one box


@dataclass(frozen=True)
class Sides:
    """A test on which sides of planes a set of points lies.

    Attributes
    ----------
    of : callable
        Takes k planes n . x = h, as normals (k, 3) and heights (k,). Returns two boolean arrays (k,): True where any
        point lies above the plane, and where any lies below.
    count : int, number of points tested per plane, for the size of chunks
    """

    of: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
    count: int


def screens_of(mirrors: TriangleMesh, ends: TriangleMesh, scene: TriangleMesh) -> TriangleMesh | None:
    """Return the triangles of the `scene` that may occlude light between mirrors and the `ends` of rays, or None."""
    room = _room(mirrors, ends)
    return _between(scene, _sides_of(mirrors, room), _sides_of(ends, room), room)


def shades_of(lamp: Lamp, mirror: TriangleMesh, scene: TriangleMesh) -> TriangleMesh | None:
    """Return the triangles of the `scene` that may cast shadows from a lamp on a mirror, or None."""
    room = _room(mirror, mirror)

    def of_lamp(normal: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        above = -(normal @ lamp.place) if lamp.sun else normal @ lamp.place - height
        return above > 0.0, above < 0.0

    return _between(scene, Sides(of_lamp, 1), _sides_of(mirror, room), room)


def _room(*meshes: TriangleMesh) -> float:
    used = np.concatenate([mesh.positions[mesh.triangles].reshape(-1, 3) for mesh in meshes])
    return ABOVE * float(np.ptp(used, axis=0).max())


def _sides_of(mesh: TriangleMesh, room: float) -> Sides:
    """Build the side-of-plane test for the corners of a mesh; points closer than `room` count as in the plane."""
    points = mesh.positions[np.unique(mesh.triangles)]
    points = points[along_curve(points)]
    # the outermost points in some directions decide most planes, boxes around nearby points nearly all others
    outermost = points[np.unique([np.argmax(points @ way) for way in spread_directions(WAYS)])]
    begin = np.arange(0, len(points), TOGETHER)
    count = np.diff(begin, append=len(points))
    low, high = np.minimum.reduceat(points, begin), np.maximum.reduceat(points, begin)

    def over(normal: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Return True (k,) for planes, as normals (k, 3) and heights (k,), with any point above them."""
        height = height + room
        found = (outermost @ normal.T).max(axis=0) > height
        doubtful = np.flatnonzero(~found)
        for part in shares(np.full(len(doubtful), len(begin)), AT_ONCE):
            plane = doubtful[part]
            reach = np.maximum(normal[plane], 0.0) @ high.T + np.minimum(normal[plane], 0.0) @ low.T
            which, box = np.nonzero(reach > height[plane, None])
            for share in shares(count[box], FEW_AT_ONCE):
                point, pair = ranges(begin[box[share]], count[box[share]])
                own = plane[which[share]][pair]
                found[own[np.einsum("ij,ij->i", normal[own], points[point]) > height[own]]] = True
        return found

    return Sides(lambda normal, height: (over(normal, height), over(-normal, -height)), len(outermost))


def _between(scene: TriangleMesh, start: Sides, end: Sides, room: float) -> TriangleMesh | None:
    """Select triangles of a scene whose plane has points of `start` on one side and points of `end` on the other.

    Return None if there are none. Planes that differ by rounding are tested once; `room` is the tolerance of heights.
    """
    if not len(scene.triangles):
        return None
    normal = scene.face_normals()
    height = np.einsum("ij,ij->i", normal, scene.positions[scene.triangles[:, 0]])
    key = np.rint(np.column_stack((normal / PLANES, height * (ABOVE / PLANES / room))))
    _, first, plane = np.unique(key, axis=0, return_index=True, return_inverse=True)
    hides = np.zeros(len(first), dtype=bool)
    for part in shares(np.full(len(first), start.count + end.count), AT_ONCE):
        planes = normal[first[part]], height[first[part]]
        (above, below), (end_above, end_below) = start.of(*planes), end.of(*planes)
        hides[part] = (above & end_below) | (below & end_above)
    chosen = hides[plane.reshape(-1)]
    return TriangleMesh(scene.positions, scene.triangles[chosen]) if chosen.any() else None
