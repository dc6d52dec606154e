"""Which triangles of a scene can hide anything: behind whose planes something lies, as what is before them sees it.

In an empty room with a flat floor none does, and what cannot hide need not be asked again and again.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, ranges, shares, spread_directions
from ..trees import along_curve
from .lamps import Lamp

ABOVE = 1e-7  # of the scene's size: what lies less far behind a triangle lies in its plane
PLANES = 1e-6  # of a unit normal, and of the scene's size: planes that differ by less are one
AT_ONCE, FEW_AT_ONCE = 1 << 22, 1 << 18
WAYS = 200  # in which a mesh's outermost corners are looked for
TOGETHER = 32  # corners side by side, in one box


@dataclass(frozen=True)
class Sides:
    """Where things lie.

    Attributes
    ----------
    of : callable
        Whether any of them lies above planes n . x = h of normals (n, 3) and heights (n,), and whether any lies below.
    count : int, how many of them are asked of each plane
    """

    of: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
    count: int


def screens_of(mirrors: TriangleMesh, ends: TriangleMesh, scene: TriangleMesh) -> TriangleMesh | None:
    """What of the `scene` may stand between mirrors and the `ends` of light; None where nothing does."""
    room = _room(mirrors, ends)
    return _between(scene, _sides_of(mirrors, room), _sides_of(ends, room), room)


def shades_of(lamp: Lamp, mirror: TriangleMesh, scene: TriangleMesh) -> TriangleMesh | None:
    """What of the `scene` may stand between a lamp and a mirror; None where nothing does."""
    room = _room(mirror, mirror)

    def of_lamp(normal: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        above = -(normal @ lamp.place) if lamp.sun else normal @ lamp.place - height
        return above > 0.0, above < 0.0

    return _between(scene, Sides(of_lamp, 1), _sides_of(mirror, room), room)


def _room(*meshes: TriangleMesh) -> float:
    used = np.concatenate([mesh.positions[mesh.triangles].reshape(-1, 3) for mesh in meshes])
    return ABOVE * float(np.ptp(used, axis=0).max())


def _sides_of(mesh: TriangleMesh, room: float) -> Sides:
    """Where the corners of a mesh lie."""
    points = mesh.positions[np.unique(mesh.triangles)]
    points = points[along_curve(points)]
    # the outermost in some directions tell of most planes, boxes round what lies together of nearly all others
    outermost = points[np.unique([np.argmax(points @ way) for way in spread_directions(WAYS)])]
    begin = np.arange(0, len(points), TOGETHER)
    count = np.diff(begin, append=len(points))
    low, high = np.minimum.reduceat(points, begin), np.maximum.reduceat(points, begin)

    def over(normal: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Whether any lies above planes."""
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
    """The triangles of a scene on one side of whose planes some of the start lies, and on the other some of the end."""
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
