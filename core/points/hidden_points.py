"""Points that lie behind a mirror, seen from the places on the mirrors that show them."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import ABOVE, SceneAndMirrors
from ..geometry import mask, norm, unit
from ..trees import Bound, first_crossed

MOST_PAIRS = 1 << 22  # of cameras and triangles of mirrors that are looked for; where more are, all may be hidden


def hidden_by_mirrors(met: SceneAndMirrors, cameras: Cameras, camera: np.ndarray,
                      places: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which of the `points` (3, n), seen at `places` (3, n) in the cameras (n,), lie behind a mirror."""
    found = met.mirrors_in(cameras, Bound(MOST_PAIRS, np.ones(len(cameras))))
    seeing = found.given_up | mask(len(cameras), found.cone)
    asked, hidden = np.flatnonzero(seeing[camera]), np.zeros(len(camera), dtype=bool)
    # a point on a mirror has no way to go
    way, room = points[:, asked] - places[:, asked], ABOVE * met.size
    hidden[asked] = first_crossed(met.mirror_tree, places[:, asked], unit(way), room, limit=norm(way) - room)[0] >= 0
    return hidden
