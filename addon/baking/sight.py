"""The one place from which an object looks most nearly as it is seen."""
from __future__ import annotations

import numpy as np

from ...core import breathe

ROUNDS = 4  # in which it is found


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
    places, angles = start, np.zeros(count)
    for _ in range(ROUNDS):
        breathe()
        # squares of angles are squares of distances from lines by those from the points
        offset = places[owner] - points
        share = weight / np.maximum(np.einsum("ni,ni->n", offset, offset), 1e-30)
        turned = np.linalg.norm(np.cross(offset, ways), axis=1)
        off = np.arctan2(turned, np.einsum("ni,ni->n", offset, ways))
        whole = np.maximum(np.bincount(owner, weights=weight, minlength=count), 1e-300)
        angles = np.sqrt(np.bincount(owner, weights=weight * off**2, minlength=count) / whole)
        matrix, aim = np.zeros((count, 3, 3)), np.zeros((count, 3))
        breathe()
        np.add.at(matrix, owner, share[:, None, None] * across)
        np.add.at(aim, owner, share[:, None] * np.einsum("nij,nj->ni", across, points))
        # a little towards where it was: lines that are all but parallel meet nowhere
        hold = 1e-6 * np.trace(matrix, axis1=1, axis2=2)[:, None] + 1e-300
        places = np.linalg.solve(matrix + hold[..., None] * np.eye(3), (aim + hold * places)[..., None])[..., 0]
    return places, angles
