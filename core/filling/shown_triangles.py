"""What rays through places on the mirror show."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import SceneAndMirrors
from ..geometry import norm
from ..result import DEPTH, GAP


def shown_triangles(met: SceneAndMirrors, cameras: Cameras, places: np.ndarray) -> np.ndarray:
    """The triangle (n,) that the ray through a place (3, n) on each camera meets first, -1 where it meets none, or
    where the scene hides the place from as near as layers slide: what is shown there would come out before it."""
    view, triangle = cameras.view, met.shown_at(cameras, places)
    back = -view.directions(places.T).T
    away = norm(back)
    reach = (GAP + DEPTH) * (np.full(len(away), np.ptp(cameras.places, axis=1).max()) if view.orthographic else away)
    return np.where(met.hidden_within(places, back / away, reach), -1, triangle)
