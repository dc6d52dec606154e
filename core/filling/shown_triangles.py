"""Triangles that rays through places on the mirror show."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import SceneAndMirrors
from ..geometry import in_order, norm, unit
from ..result import DEPTH, GAP

MOST_LAYERS = 32  # largest number of triangles that one ray hits, clear ones included
STEP = 1e-9  # relative offset behind a clear triangle from which the ray continues


def shown_triangles(met: SceneAndMirrors, cameras: Cameras, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the triangles that the rays through one place on each camera show.

    A place shows nothing if a scene object is so close in front of it that the layer would appear in front of the
    object.

    Parameters
    ----------
    places : (3, n) float64, one place on each camera, in world space

    Returns
    -------
    place : (k,) int64, index of a place, rising; one entry for each triangle
    triangle : (k,) int64, clear triangles, nearest first, and the first that is not clear; -1 for none
    """
    view, (place, triangle) = cameras.view, met_in_turn(met, cameras, places)
    back = -view.directions(places.T).T
    away = norm(back)
    size = np.full(len(away), np.ptp(cameras.places, axis=1).max()) if view.orthographic else away
    reach = met.slide * (GAP + DEPTH) * size
    return place, np.where(met.hidden_within(places, back / away, reach)[place], -1, triangle)


def met_in_turn(met: SceneAndMirrors, cameras: Cameras, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the triangles that the rays through one place on each camera hit; the same results as `shown_triangles`,
    without its test for objects in front.
    """
    mirror_map, sides = cameras.mirror_map, met.upper_sides(cameras)
    origin, ray = mirror_map.leave(cameras.face, mirror_map.coordinates(cameras.face, places))
    own, ray, found = np.arange(len(cameras)), unit(ray), []
    for layer in range(MOST_LAYERS):
        triangle, away = met.first_met(sides, origin, ray)
        kept = (triangle >= 0) | (layer == 0)
        found.append((own[kept], triangle[kept]))
        on = np.flatnonzero((triangle >= 0) & ~met.opacities.stops_light(triangle))
        if not len(on):
            break
        own, ray, origin = own[on], ray[:, on], origin[:, on] + (1.0 + STEP) * away[on] * ray[:, on]
        sides = sides[0][:, on], sides[1][:, on]
    place, triangle = (np.concatenate(part) for part in zip(*found))
    order = in_order(place)
    return place[order], triangle[order]
