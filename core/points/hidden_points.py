"""Test for points that a mirror hides from the place on the mirror that shows them."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import ABOVE, SceneAndMirrors
from ..geometry import mask, norm, unit
from ..trees import Bound, first_crossed

MOST_PAIRS = 1 << 22  # largest number of pairs of a camera and a mirror triangle; beyond it all points are tested


def hidden_by_mirrors(met: SceneAndMirrors, cameras: Cameras, camera: np.ndarray,
                      places: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return True (n,) for points that a mirror hides.

    Parameters
    ----------
    camera : (n,) int64, camera that shows each point
    places, points : (3, n) float64, images on the mirror, and reflected points, in world space
    """
    found = met.mirrors_in(cameras, Bound(MOST_PAIRS, np.ones(len(cameras))))
    seeing = found.given_up | mask(len(cameras), found.cone)
    asked, hidden = np.flatnonzero(seeing[camera]), np.zeros(len(camera), dtype=bool)
    # shorten the rays by the tolerance, so that a point on a mirror is not hidden by that mirror
    way, room = points[:, asked] - places[:, asked], ABOVE * met.size
    hidden[asked] = first_crossed(met.mirror_tree, places[:, asked], unit(way), room, limit=norm(way) - room)[0] >= 0
    return hidden
