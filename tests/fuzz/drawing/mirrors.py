"""Mirrors drawn at random: small ones, of every kind that a reflection can go wrong in."""
from __future__ import annotations

import numpy as np

from core import TriangleMesh
from tests.inputs import shapes

LENGTH_OF_A_SIDE = 2.0


def _grid(cells: int, height) -> tuple[np.ndarray, np.ndarray]:
    """A square about the origin, `height(x, y)` above it."""
    def surface(x, y):
        places = np.stack([x, y, height(x, y)], axis=1)
        return places, np.zeros_like(places)
    half = 0.5 * LENGTH_OF_A_SIDE
    return shapes.sheet(surface, cells, cells, (-half, half), (-half, half))[:2]


def _ball(rng: np.random.Generator) -> tuple:
    if rng.random() < 0.3:
        return shapes.icosphere((0.0, 0.0, 0.0), 1.0, int(rng.integers(0, 2)))[:2]
    return shapes.uv_sphere((0.0, 0.0, 0.0), 1.0, int(rng.integers(4, 12)), int(rng.integers(3, 9)))[:2]


def _plate(rng: np.random.Generator) -> tuple:
    return _grid(int(rng.integers(1, 4)), lambda x, y: 0.0 * x)


def _rough_grid(rng: np.random.Generator) -> tuple:
    roughness = rng.choice([0.01, 0.1, 0.3])
    return _grid(int(rng.integers(1, 6)), lambda x, y: rng.normal(0.0, roughness, len(x)))


def _saddle(rng: np.random.Generator) -> tuple:
    return _grid(5, lambda x, y: 0.3 * (x**2 - y**2))


def _bowl(rng: np.random.Generator) -> tuple:
    depth = rng.uniform(0.1, 0.8)
    return _grid(5, lambda x, y: depth * (x**2 + y**2))


def _waves(rng: np.random.Generator) -> tuple:
    height, length = rng.uniform(0.02, 0.2), rng.uniform(2.0, 8.0)
    return _grid(7, lambda x, y: height * np.sin(length * x + y))


def _soup(rng: np.random.Generator) -> tuple:
    count = int(rng.integers(1, 9))
    return rng.normal(0.0, 1.0, (3 * count, 3)), np.arange(3 * count).reshape(-1, 3)


def _cube(rng: np.random.Generator) -> tuple:
    return shapes.box((0.0, 0.0, 0.0), (LENGTH_OF_A_SIDE,) * 3)[:2]


def _fold(rng: np.random.Generator) -> tuple:
    """Two triangles, bent at the edge that they share."""
    positions, triangles, _ = shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    positions[3, 2] = rng.normal(0.0, 0.4)
    return positions, triangles


def _pipe(rng: np.random.Generator) -> tuple:
    return shapes.cylinder((0.0, 0.0, 0.0), 0.7, LENGTH_OF_A_SIDE, int(rng.integers(4, 12)))[:2]


SURFACES = {"ball": _ball, "plate": _plate, "rough grid": _rough_grid, "saddle": _saddle, "bowl": _bowl,
            "waves": _waves, "soup": _soup, "cube": _cube, "fold": _fold, "pipe": _pipe}


def vertex_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The mean (n, 3) of the normals round each vertex, larger triangles counting more; +Z where there is none."""
    corners = positions[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(positions)
    np.add.at(normals, triangles.ravel(), np.repeat(across, 3, axis=0))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0])


def drawn_mirror(rng: np.random.Generator) -> tuple[list[str], TriangleMesh]:
    """A mirror of about two units round the origin, and what it is called: its surface and its normals."""
    kind = str(rng.choice(list(SURFACES)))
    positions, triangles = SURFACES[kind](rng)
    shading = str(rng.choice(["smooth", "flat", "bent"], p=[0.65, 0.2, 0.15]))
    if shading == "flat":
        return [kind, shading], TriangleMesh(positions, triangles)
    normals = vertex_normals(positions, triangles)
    if shading == "bent":
        normals = normals + rng.normal(0.0, 0.3, normals.shape)
    return [kind, shading], TriangleMesh(positions, triangles, normals[triangles])
