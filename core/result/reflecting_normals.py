"""Normals that a mirror must have to show given points at given places, by the law of reflection."""
from __future__ import annotations

import numpy as np

from ..geometry import unit
from ..views import View


def reflecting_normals(view: View, mirror_position: np.ndarray, reflected_position: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3), in world space and towards the eye, of a mirror that shows the points `reflected_position`
    (n, 3) at `mirror_position` (n, 3).

    Where a point lies on the mirror its way has no direction, and the normal is the way to the eye.

    Examples
    --------
    >>> import numpy as np
    >>> from core import View, reflecting_normals
    >>> view = View.looking_at((0, -2, 2), (0, 0, 0), (64, 64))
    >>> reflecting_normals(view, np.zeros((1, 3)), np.array([[0.0, 3.0, 3.0]])).round(6).tolist()
    [[0.0, 0.0, 1.0]]
    """
    return halfway(view.directions(mirror_position).T, (reflected_position - mirror_position).T).T


def halfway(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Unit normals (3, n) of mirrors that turn sight along `before` (3, n) to sight along `after`."""
    return unit(unit(after) - unit(before))
