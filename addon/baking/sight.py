"""The one place from which an object looks most nearly as it is seen."""
from __future__ import annotations

import numpy as np

from ...core import breathe

ROUNDS = 4  # in which it is found
FAR = 1e3   # times what an object measures: from there all of it is seen along lines that are parallel


def places_of_sight(owner: np.ndarray, weight: np.ndarray, points: np.ndarray, towards: np.ndarray,
                    start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The places from which sources look most nearly as they are seen, and how far that is from how they are.

    Parameters
    ----------
    owner : (n,) int
        The source of each point.
    weight : (n,) float64
    points, towards : (n, 3) float64
        Each is seen along a line, from the latter.
    start : (k, 3) float64
        Places by source, that are kept where the lines tell nothing.

    Returns
    -------
    places : (k, 3) float64
    angles : (k,) float64
        In radians, the root of the mean square.
    """
    count = len(start)
    ways = towards - points
    ways = ways / np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-30)
    across = np.eye(3) - ways[:, :, None] * ways[:, None, :]
    places = start
    for _ in range(ROUNDS):
        breathe()
        # squares of angles are squares of distances from lines by those from the points
        offset = places[owner] - points
        share = weight / np.maximum(np.einsum("ni,ni->n", offset, offset), 1e-30)
        matrix, aim = np.zeros((count, 3, 3)), np.zeros((count, 3))
        breathe()
        np.add.at(matrix, owner, share[:, None, None] * across)
        np.add.at(aim, owner, share[:, None] * np.einsum("nij,nj->ni", across, points))
        # a little towards where it was: lines that are all but parallel meet nowhere
        hold = 1e-6 * np.trace(matrix, axis1=1, axis2=2)[:, None] + 1e-300
        places = np.linalg.solve(matrix + hold[..., None] * np.eye(3), (aim + hold * places)[..., None])[..., 0]
    angles, told = _angles(owner, weight, places[owner] - points, ways, count), _means(owner, weight, points, count)
    away = points - told[owner]
    size = np.sqrt(_means(owner, weight, np.einsum("ni,ni->n", away, away)[:, None], count))
    far = told + FAR * size * _means(owner, weight, ways, count)
    straight = _angles(owner, weight, far[owner] - points, ways, count)
    better = (straight < angles) & (size[:, 0] > 0.0)
    return np.where(better[:, None], far, places), np.where(better, straight, angles)


def _angles(owner: np.ndarray, weight: np.ndarray, offset: np.ndarray, ways: np.ndarray, count: int) -> np.ndarray:
    """How far `ways` (n, 3) stray from `offset` (n, 3), the way to a place, by source."""
    off = np.arctan2(np.linalg.norm(np.cross(offset, ways), axis=1), np.einsum("ni,ni->n", offset, ways))
    return np.sqrt(_means(owner, weight, off[:, None]**2, count))[:, 0]


def _means(owner: np.ndarray, weight: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """The mean (k, c) of values (n, c) by source."""
    whole = np.maximum(np.bincount(owner, weights=weight, minlength=count), 1e-300)
    return np.stack([np.bincount(owner, weights=weight * one, minlength=count) / whole for one in values.T], axis=1)
