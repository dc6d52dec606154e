"""Where the scene cuts through a patch, or stands on it: there it hides the mirror from quite near.

Faces that slide towards the eye would come out before what hides them so closely; cameras are cut there
(`visibility.scene_contacts`), and have to show what a whole face would.
"""
from __future__ import annotations

import numpy as np

from ..culling import Balls, SceneTree
from ..geometry import cross, dot, norm, unit
from ..patches import Patch
from ..result import DEPTH, GAP
from ..support import breathe

LARGE = 256.0  # pixels: larger triangles of the mirror are cut too often to be cut along pieces of the scene


def contacts(patch: Patch, tree: SceneTree) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (n,) of the scene that come as near to the patch as faces slide; and which of the patch's triangles
    (k,) that they meet are large."""
    corners = patch.mirror_map.surface.corners(patch.face)
    middle = corners.mean(axis=1)
    slid = (GAP + DEPTH) * patch.far(corners - patch.eye[:, None])
    radius = norm(corners - middle[:, None]).max(axis=0) + slid
    near, met = [np.zeros(0, dtype=np.int64)], np.zeros(len(patch), dtype=bool)
    for member, triangle, _ in tree.traced(Balls(middle, radius), np.ones(len(patch), dtype=bool)):
        breathe()
        scene = np.moveaxis(tree.mesh.positions[tree.mesh.triangles[triangle]], 2, 0).swapaxes(1, 2)
        meeting = _meeting(corners[:, :, member], scene, slid[member])
        near.append(np.unique(triangle[meeting]))
        met[member[meeting]] = True
    spots = patch.pixels((corners - patch.eye[:, None]).reshape(3, -1)).reshape(2, 3, -1)
    return np.unique(np.concatenate(near)), met & (np.ptp(spots, axis=1).max(axis=0) > LARGE)


def _meeting(mirror: np.ndarray, scene: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Which pairs (n,) of triangles with corners (3, 3, n), as [component, corner, pair], come as near as `room`: where
    both lie so near the other's plane, they do so side by side along the line in which the planes meet."""
    meeting, heights, normals = np.ones(len(room), dtype=bool), [], []
    for plane, other in ((mirror, scene), (scene, mirror)):
        normals.append(unit(cross(plane[:, 1] - plane[:, 0], plane[:, 2] - plane[:, 0])))
        heights.append(dot(normals[-1][:, None], other - plane[:, :1]))
        meeting &= (heights[-1].min(axis=0) <= room) & (heights[-1].max(axis=0) >= -room)
    some = np.flatnonzero(meeting)
    along = unit(cross(*(normal[:, some] for normal in normals)))
    (first, last), (low, high) = (_reach(triangle[:, :, some] - mirror[:, :1, some], height[:, some], room[some], along)
                                  for triangle, height in ((scene, heights[0]), (mirror, heights[1])))
    meeting[some] = (first <= high + room[some]) & (low <= last + room[some])
    return meeting


def _reach(corners: np.ndarray, height: np.ndarray, room: np.ndarray,
           along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From where to where along unit vectors (3, n) the parts of triangles with `corners` (3, 3, n) go that lie within
    `room` of a plane, their corners at `height` (3, n)."""
    at = dot(corners, along[:, None])
    inside = np.abs(height) <= room
    low, high = (pick(np.where(inside, at, none), axis=0) for pick, none in ((np.min, np.inf), (np.max, -np.inf)))
    for k in range(3):
        start, end, here, there = height[k], height[(k + 1) % 3], at[k], at[(k + 1) % 3]
        for level in (-room, room):
            crossing = (start - level) * (end - level) < 0.0
            spot = here + (there - here) * (level - start) / np.where(crossing, end - start, 1.0)
            low = np.where(crossing, np.minimum(low, spot), low)
            high = np.where(crossing, np.maximum(high, spot), high)
    return low, high
