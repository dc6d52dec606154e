"""Three-ray cameras without a mirror: triangles at random places with rays that lean away from a common direction."""
import numpy as np

from core.cameras.three_ray_cameras import Cameras


def random_cameras(rng, count, size=0.3, turn=0.3):
    """`count` cameras of about `size` within two units of the origin, whose rays differ by about `turn` radians."""
    places = rng.uniform(-2.0, 2.0, (count, 1, 3)) + rng.normal(scale=size, size=(count, 3, 3))
    rays = rng.normal(size=(count, 1, 3))
    rays = rays / np.linalg.norm(rays, axis=2, keepdims=True) + rng.normal(scale=turn, size=(count, 3, 3))
    rays *= rng.uniform(0.5, 2.0, (count, 3, 1))
    places, rays = places.reshape(-1, 3).T, rays.reshape(-1, 3).T
    return Cameras(np.arange(3 * count).reshape(-1, 3), np.arange(count), places, rays)
