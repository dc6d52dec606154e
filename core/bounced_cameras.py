"""Cameras of the next bounce: the images of mirrors in a mirror carry three-ray cameras of their own."""
from __future__ import annotations

import numpy as np

from .bounce import Bounce
from .cameras import BouncedMap, Cameras
from .culling import SceneAndMirrors
from .geometry import doubled_areas, groups, norm

SAME_RAY = 1e-7  # of its length: rays at one node that differ by less are one ray
PATCHES = 8  # smooth patches of a mirror that meet in a node; more share no corners
SMALLEST = 1e-4  # square pixels: a smaller image of a mirror shows nothing


def bounced_cameras(bounce: Bounce, met: SceneAndMirrors) -> Cameras:
    """A camera on each face that shows a mirror, sharing the corners at which the ray goes on the same way.

    Returns
    -------
    cameras : Cameras
        On the map of one bounce more; their faces are the chains of triangles that are seen.
    """
    frames, nodes, faces, before = bounce.frames, bounce.nodes, bounce.faces, bounce.cameras.mirror_map
    triangle = frames.triangle[faces.column] - met.diffuse
    pixels = before.view.pixels(nodes.place.T)[faces.nodes]
    large = np.abs(doubled_areas(pixels)) > SMALLEST
    seen = np.flatnonzero(met.reflects(frames)[faces.column] & large)
    face_before, triangle = bounce.cameras.face[faces.camera[seen]], triangle[seen]
    first, chain = groups(face_before, triangle)
    bounced = BouncedMap(before, met.surface, face_before[first], triangle[first], before.unit_rays)

    node, face = faces.nodes[seen].ravel(), np.repeat(chain, 3)
    origins, rays = bounced.leave(face, bounced.coordinates(face, nodes.place[:, node]))
    corner, chosen = _shared(node, rays)
    places, origins, rays = nodes.place[:, node[chosen]], origins[:, chosen], rays[:, chosen]
    return Cameras(corner.reshape(-1, 3), chain, places, rays, origins, bounced)


def _shared(node: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which corners (n,) are one, since they lie on one node and have one ray; and the first of each."""
    like = np.full(len(node), -1)
    rest = np.arange(len(node))
    for _ in range(PATCHES):
        first, group = groups(node[rest])
        leader = rest[first][group]
        same = norm(rays[:, rest] - rays[:, leader]) <= SAME_RAY * norm(rays[:, leader])
        like[rest[same]] = leader[same]
        rest = rest[~same]
        if not len(rest):
            break
    like[rest] = rest
    chosen, corner = np.unique(like, return_inverse=True)
    return corner, chosen
