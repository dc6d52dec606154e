"""Three-ray cameras without a mirror: triangles at random places with rays that lean away from a common direction."""
from dataclasses import replace

import numpy as np

from core import TriangleMesh, View
from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import Cameras

VIEW = View.looking_at((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), (64, 64))


def cameras_of(places, rays, view=VIEW):
    """A camera on each triangle of `places` (n, 3, 3) with any `rays` (n, 3, 3): the map is that of these triangles as
    a mirror, and knows nothing of the rays."""
    count = len(places)
    corners, places = np.arange(3 * count).reshape(-1, 3), places.reshape(-1, 3)
    mirror_map = MirrorMap(view, TriangleMesh(places, corners))
    return Cameras(corners, np.arange(count), places.T, rays.reshape(-1, 3).T, places.T, mirror_map)


def moved(cameras, scale, offset):
    """The same cameras larger and elsewhere."""
    places = cameras.places * scale + offset
    return replace(cameras, places=places, rays=cameras.rays * scale, origins=places)


def random_cameras(rng, count, size=0.3, turn=0.3):
    """`count` cameras of about `size` within two units of the origin, whose rays differ by about `turn` radians."""
    places = rng.uniform(-2.0, 2.0, (count, 1, 3)) + rng.normal(scale=size, size=(count, 3, 3))
    rays = rng.normal(size=(count, 1, 3))
    rays = rays / np.linalg.norm(rays, axis=2, keepdims=True) + rng.normal(scale=turn, size=(count, 3, 3))
    rays *= rng.uniform(0.5, 2.0, (count, 3, 1))
    return cameras_of(places, rays)


def random_families(rng, count, turn):
    """`random_cameras`, those that look nearly the same way side by side, as on one triangle of a mirror; and where
    runs of about three begin."""
    cameras = random_cameras(rng, count, turn=turn)
    direction = cameras.rays[:, cameras.corners].sum(axis=2)
    cameras = cameras.select(np.lexsort(np.round(direction / np.linalg.norm(direction, axis=0))))
    return cameras, np.flatnonzero(np.append(True, rng.uniform(size=count - 1) < 0.3))
