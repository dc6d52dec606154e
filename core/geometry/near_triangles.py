"""Test for triangles that come near each other."""
from __future__ import annotations

import numpy as np

from .subdivision import next_corner
from .vectors import cross, dot, unit


def meeting(one: np.ndarray, other: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Return True (n,) for pairs of triangles that come as near as `room`.

    Each triangle must have a part that near to the other's plane. Along the line in which the planes meet, these parts
    must overlap.

    Parameters
    ----------
    one, other : (3, 3, n) float64, corners, as [component, corner, pair]
    room : (n,) float64, distance in scene units
    """
    near, heights, normals = np.ones(len(room), dtype=bool), [], []
    for plane, corners in ((one, other), (other, one)):
        normals.append(unit(cross(plane[:, 1] - plane[:, 0], plane[:, 2] - plane[:, 0])))
        heights.append(dot(normals[-1][:, None], corners - plane[:, :1]))
        near &= (heights[-1].min(axis=0) <= room) & (heights[-1].max(axis=0) >= -room)
    some = np.flatnonzero(near)
    along = unit(cross(*(normal[:, some] for normal in normals)))
    (first, last), (low, high) = (_reach(triangle[:, :, some] - one[:, :1, some], height[:, some], room[some], along)
                                  for triangle, height in ((other, heights[0]), (one, heights[1])))
    near[some] = (first <= high + room[some]) & (low <= last + room[some])
    return near


def _reach(corners: np.ndarray, height: np.ndarray, room: np.ndarray,
           along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the interval along a direction of the parts of triangles that lie near a plane, as low and high (n,).

    Parameters
    ----------
    corners : (3, 3, n) float64, as [component, corner, triangle]
    height : (3, n) float64, heights of the corners above the plane
    room : (n,) float64, largest distance from the plane
    along : (3, n) float64, unit vectors
    """
    at = dot(corners, along[:, None])
    inside = np.abs(height) <= room
    low, high = (pick(np.where(inside, at, none), axis=0) for pick, none in ((np.min, np.inf), (np.max, -np.inf)))
    for k in range(3):
        start, end, here, there = height[k], height[next_corner(k)], at[k], at[next_corner(k)]
        for level in (-room, room):
            crossing = (start - level) * (end - level) < 0.0
            spot = here + (there - here) * (level - start) / np.where(crossing, end - start, 1.0)
            low = np.where(crossing, np.minimum(low, spot), low)
            high = np.where(crossing, np.maximum(high, spot), high)
    return low, high
