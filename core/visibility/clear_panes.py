"""Clear triangles close before the mirror, as panes and films: layers slide less there, so as to stay behind them."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import SceneAndMirrors
from ..geometry import in_order, meeting, norm, rows
from ..result import DEPTH, GAP
from ..trees import Balls, SceneTree, curve_leaves, depth_for

SHARES = (1.0, 0.5, 0.25, 0.125)
"""Of what layers slide elsewhere. In single precision a smaller share would mix up layers that lie close together: at
an eighth, pictures 2 cm before a wall are still told from it, 8 m from a mirror that is 3 m away."""
TOUCHING = 1.0 / 64.0  # share of the distance that layers slide: closer panes lie on the mirror, before all layers
FAMILY = 16  # cameras per bounding sphere


def slide_share(cameras: Cameras, met: SceneAndMirrors) -> tuple[float, int]:
    """Choose a share of the distance that layers slide that keeps them behind triangles that let light through.

    The share is the same all over the mirror: if it changed between the corners of a face, layers would cross.

    Returns
    -------
    share : float, one of `SHARES`; 1 if no triangle lets light through
    close : int, number of triangles that let light through, but are too close for any share: they hide layers behind
    """
    mesh, opacities = met.tree.mesh, met.opacities
    asked = np.flatnonzero(~opacities.stops_light(np.arange(len(mesh.triangles))))
    if not len(asked):
        return 1.0, 0
    corners = np.take(cameras.places, cameras.corners.T, axis=1)
    view, share, close = cameras.view, SHARES[0], np.zeros(len(asked), dtype=bool)
    size = np.full(len(cameras), np.ptp(cameras.places, axis=1).max()) if view.orthographic else \
        norm(corners - view.eye[:, None, None]).max(axis=0)
    slid, middle = (GAP + DEPTH) * size, corners.mean(axis=1)
    order = in_order(family := curve_leaves(middle.T, depth_for(len(cameras), FAMILY)))
    balls = Balls(middle[:, order], (norm(corners - middle[:, None]).max(axis=0) + slid)[order])
    tree = SceneTree.of_ordered(mesh.like(mesh.positions, mesh.triangles[asked], None))
    for place, triangle, _ in tree.traced(balls, np.ones(len(cameras), dtype=bool), family[order]):
        one = corners[:, :, order[place]], rows(mesh.positions[tree.mesh.triangles[triangle].T]), slid[order[place]]
        close[triangle[meeting(*one[:2], SHARES[-1] * one[2])]] = True
        above = ~meeting(*one[:2], TOUCHING * one[2])
        place, other, room = (part[..., above] for part in one)
        # shares go down, and never up again
        share = next((less for less in SHARES[:-1] if less <= share and not meeting(place, other, less * room).any()),
                     SHARES[-1])
    return share, int((close & opacities.not_to_cover(asked)).sum())
