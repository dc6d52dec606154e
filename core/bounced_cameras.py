"""Cameras of the next bounce: one three-ray camera on each face that shows a mirror."""
from __future__ import annotations

import numpy as np

from .bounce import Bounce
from .cameras import BouncedMap, Cameras, ray_numbers
from .culling import SceneAndMirrors
from .geometry import distinct, doubled_areas, groups

SMALLEST = 1e-4  # square pixels (doubled area): smaller images of mirrors are ignored


def bounced_cameras(bounce: Bounce, met: SceneAndMirrors) -> Cameras:
    """Make a camera on each face that shows a mirror; corners on one node with the same reflected ray are shared.

    Returns
    -------
    cameras : Cameras, on the map with one bounce more; their faces are chains of mirror triangles
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
    # share corners on one node with the same ray
    first, own = groups(node, *ray_numbers(rays))
    chosen, corner = distinct(first[own])
    places, origins, rays = nodes.place[:, node[chosen]], origins[:, chosen], rays[:, chosen]
    return Cameras(corner.reshape(-1, 3), chain, places, rays, origins, bounced)
