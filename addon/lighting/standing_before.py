"""What the camera looks through to see what mirrors show."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from ...core import View, breathe

RAYS = 600       # that look for it
MOST_THROUGH = 16  # surfaces one behind the other
NEARLY = 1e-4    # of a way: what lies so near to its ends lies there


def standing_before(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, view: View,
                    places: np.ndarray) -> set:
    """The objects between the eye of a view and places (n, 3) on mirrors, found by rays to some of them."""
    chosen = places[np.unique(np.linspace(0, len(places) - 1, min(RAYS, len(places))).astype(np.int64))]
    origins, _ = view.rays(view.pixels(chosen))
    found: set = set()
    for number, (start, end) in enumerate(zip(map(Vector, origins.tolist()), map(Vector, chosen.tolist()))):
        if number % 100 == 0:
            breathe()
        way = end - start
        direction, step, at = way.normalized(), NEARLY * way.length, start
        for _ in range(MOST_THROUGH):
            left = (end - at).dot(direction) - step
            hit, place, _, _, obj, _ = scene.ray_cast(depsgraph, at, direction, distance=left) if left > 0.0 else (
                False, None, None, None, None, None)
            if not hit:
                break
            found.add(obj.original)
            at = place + step * direction
    return found
