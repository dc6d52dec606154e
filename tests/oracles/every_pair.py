"""The plainest ray caster, for few rays and triangles: what the faster ones are compared with."""
import numpy as np


def pixel_centres(view):
    """Centres (n, 2) of the pixels, along the rows from the lower left corner."""
    width, height = view.resolution
    return np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1).reshape(-1, 2)


def every_pair(mesh, origins, directions):
    """Nearest triangle and distance by a 3 x 3 system for each ray and triangle: o + t d = a + u ab + v ac."""
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    matrix = np.empty((len(origins), len(a), 3, 3))
    matrix[..., 0], matrix[..., 1], matrix[..., 2] = -directions[:, None], b - a, c - a
    t, u, v = np.moveaxis(np.linalg.solve(matrix, (origins[:, None] - a)[..., None])[..., 0], 2, 0)
    t = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0), t, np.inf)
    nearest = t.argmin(axis=1)
    distance = t[np.arange(len(t)), nearest]
    return np.where(np.isfinite(distance), nearest, -1), distance
