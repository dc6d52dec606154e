"""Cones through a tree in shares that fit the memory, as long as they meet no more than a picture can be worth."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields

import numpy as np

from .cones import Cones
from .errors import ReflectionError
from .scene_tree import SceneTree

PAIRS_AT_ONCE, SMALLEST_SHARE = 1 << 22, 256  # of cones and triangles; of cones


def bounded_trace(tree: SceneTree, cones: Cones, most: float,
                  wanted: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None
                  ) -> tuple[np.ndarray, np.ndarray, int]:
    """Pairs of cones and triangles, those that are `wanted`, and tree nodes visited; cones go through the tree in
    shares that fit the memory even if each meets all triangles."""
    found, visited, total, count = [], 0, 0, cones.centre.shape[1]
    share = max(SMALLEST_SHARE, PAIRS_AT_ONCE // max(len(tree), 1))
    for start in range(0, max(count, 1), share):
        part = Cones(*(getattr(cones, field.name)[..., start:start + share] for field in fields(Cones)))
        cone, triangle, more = tree.trace(part)
        cone, visited = cone + start, visited + more
        if wanted is not None:
            kept = wanted(cone, triangle)
            cone, triangle = cone[kept], triangle[kept]
        found.append((cone, triangle))
        total += len(cone)
        if total > most:
            raise ReflectionError("Too much of the mirrors and the diffuse objects lies over one another for the "
                                  "maximum number of faces; simplify them or raise it.")
    return *(np.concatenate(side) for side in zip(*found)), visited
