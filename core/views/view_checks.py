"""Validation of a view's arguments: its placement, its projection and the size of its picture."""
from __future__ import annotations

import numpy as np

from ..support import whole_number

SIZE_LIMIT = 65536
"""Pixels along a side of the picture: Blender's own limit."""
LOOSE = 1e-3
"""What the axes' lengths may be off: matrices come in single precision, or from many turns multiplied."""
_EXACT = 1e-6
"""Off by less than this is rounding of single precision; axes that leave no more room between them lie in a plane."""
_NOTHING = 1e-12
"""Of the projection's scale: what is left of a zero by arithmetic."""
_STRETCH = {True: 1e50, False: 1e20}
"""The largest scale of an orthographic and of a perspective projection, and the inverse of the smallest."""


def check_placement(matrix: np.ndarray) -> None:
    """Raise ValueError if `matrix` (4, 4) is no rigid placement."""
    axes = matrix[:3, :3]
    length = np.sqrt((np.clip(axes, -2.0, 2.0)**2).sum(axis=0))  # clip axes that are too long: squares might overflow
    if (np.abs(length - 1.0) > LOOSE).any() or np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > LOOSE:
        raise ValueError("View.camera_to_world must be a rigid placement with axes of unit length and a last row of "
                         "0 0 0 1; take the scale out of it.")
    if abs(np.linalg.det(axes)) < _EXACT:
        raise ValueError("View.camera_to_world must be a rigid placement with axes that do not lie in a plane; make "
                         "them stand at right angles.")


def check_projection(matrix: np.ndarray) -> None:
    """Raise ValueError if `matrix` (4, 4) is no perspective or orthographic projection with an image."""
    orthographic = matrix[3, 2] == 0.0
    last = (0.0, 0.0, 0.0, 1.0) if orthographic else (0.0, 0.0, -1.0, 0.0)
    scale = np.abs(np.diag(matrix)[:2])
    # besides the scale only the shift may be nonzero, in a column that depends on the kind of projection
    rest = np.abs(np.stack((matrix[[0, 1], [1, 0]], matrix[:2, 2 if orthographic else 3])))
    if np.abs(matrix[3] - last).max() > _EXACT or (rest > _NOTHING * scale).any():
        raise ValueError("View.projection must be the matrix of a perspective or of an orthographic camera, with a "
                         "last row of 0 0 -1 0 or of 0 0 0 1.")
    most = _STRETCH[orthographic]
    if (scale > most).any() or (scale < 1.0 / most).any() or np.abs(matrix[:3]).max() > most:
        raise ValueError("View.projection must be the matrix of a camera that shows something; its scale is as good as "
                         "zero or infinite.")


def picture_size(resolution) -> tuple[int, int]:
    """Width and height in pixels; raises ValueError where these are none."""
    wrong = f"View.resolution must be a width and a height in whole pixels, each from 1 to {SIZE_LIMIT}."
    try:
        width, height = (whole_number(side) for side in resolution)
    except (TypeError, ValueError) as error:  # no sequence, or one of another length
        raise ValueError(wrong) from error
    if width is None or height is None or not (1 <= width <= SIZE_LIMIT and 1 <= height <= SIZE_LIMIT):
        raise ValueError(wrong)
    return width, height
