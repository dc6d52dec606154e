"""Pages of a picture: triangles that overlap in a view, spread over several pictures in each of which none do.

A texture that is unwrapped by a view needs a page of its own for each layer of what lies behind one another.
"""
from __future__ import annotations

import numpy as np

from ..support import breathe
from .view import View
from .z_buffer import fragments

MOST_PAGES = 16
"""Bound on the number of pages; what lies behind so many layers shares the last one."""
TOUCHING = 1e-9     # share of a depth by which two triangles in one pixel may differ and not hide each other


def pages_of(view: View, positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the page (m,) of each triangle, from 0 on for those that nothing hides.

    Two triangles that cover the centre of one pixel are on different pages, the nearer one on the lower page.

    Parameters
    ----------
    view : View
    positions : (v, 3) float64, in world space
    triangles : (m, 3) int64

    Examples
    --------
    >>> import numpy as np
    >>> from core import View, pages_of
    >>> view = View.looking_at((0, 0, 4), (0, 0, 0), (8, 8))
    >>> near, far = [[-1, -1, 1], [1, -1, 1], [0, 1, 1]], [[-1, -1, 0], [1, -1, 0], [0, 1, 0]]
    >>> pages_of(view, np.array(far + near), np.array([[0, 1, 2], [3, 4, 5]])).tolist()
    [1, 0]
    """
    page = np.zeros(len(triangles), dtype=np.int64)
    found = [(triangle.astype(np.int32), pixel.astype(np.int32), depth)
             for triangle, pixel, _, depth in fragments(view, positions, triangles)]
    if not found:
        return page
    triangle, pixel, depth = (np.concatenate(part) for part in zip(*found))
    breathe()
    # the layers of each pixel, one behind the other
    order = np.lexsort((depth, pixel))
    triangle, pixel, depth = triangle[order], pixel[order], depth[order]
    # a pixel's centre on the edge between two triangles belongs to both
    same = (pixel[1:] == pixel[:-1]) & (np.diff(depth) > TOUCHING * np.abs(depth[1:]))
    breathe()
    # pairs of a triangle and the next one behind it, each once
    pairs = np.unique(triangle[:-1][same].astype(np.int64) * len(triangles) + triangle[1:][same])
    before, behind = np.divmod(pairs, len(triangles))
    # the longest chain of triangles in front of each; chains may be closed where triangles cross
    for _ in range(MOST_PAGES):
        deeper = page.copy()
        np.maximum.at(deeper, behind, page[before] + 1)
        if (deeper == page).all():
            break
        page = deeper
    return np.minimum(page, MOST_PAGES - 1)
