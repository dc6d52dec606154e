"""Contacts of the scene with a patch of the mirror: the scene cuts through the patch or stands on it.

Near a contact the scene hides the mirror so closely that faces, which slide towards the eye, would come out in front of
it. Cameras are cut there (`visibility.scene_contacts`) and show the triangles in place of unclipped faces.
"""
from __future__ import annotations

import numpy as np

from ..culling import SceneAndMirrors
from ..geometry import in_order, meeting, norm, rows
from ..patches import Patch
from ..result import DEPTH, GAP
from ..trees import Balls, curve_leaves, depth_for

FAMILY = 16  # triangles of the patch that are looked at together
LARGE = 256.0  # pixels: larger triangles of the mirror are cut too often to be cut along pieces of the scene


def contacts(patch: Patch, met: SceneAndMirrors) -> tuple[np.ndarray, np.ndarray]:
    """Find the contacts of a patch of k triangles with the scene.

    Returns
    -------
    near : (n,) int64, scene triangles that must not be covered and are as near to the patch as faces slide
    large : (k,) bool, True for large triangles of the patch that they meet
    """
    tree, corners = met.scene, patch.mirror_map.surface.corners(patch.face)
    middle = corners.mean(axis=1)
    slid = met.slide * (GAP + DEPTH) * patch.far(corners - patch.eye[:, None])
    radius = norm(corners - middle[:, None]).max(axis=0) + slid
    near, touched = [np.zeros(0, dtype=np.int64)], np.zeros(len(patch), dtype=bool)
    family = curve_leaves(middle.T, depth_for(len(patch), FAMILY))
    order = in_order(family)
    balls = Balls(middle[:, order], radius[order])
    for place, triangle, _ in tree.traced(balls, np.ones(len(patch), dtype=bool), family[order]):
        member = order[place]
        scene = rows(tree.mesh.positions[tree.mesh.triangles[triangle].T])
        close = meeting(corners[:, :, member], scene, slid[member]) & met.opacities.not_to_cover(triangle)
        near.append(np.unique(triangle[close]))
        touched[member[close]] = True
    spots = patch.pixels((corners - patch.eye[:, None]).reshape(3, -1)).reshape(2, 3, -1)
    return np.unique(np.concatenate(near)), touched & (np.ptp(spots, axis=1).max(axis=0) > LARGE)
