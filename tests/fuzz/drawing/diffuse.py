"""Diffuse scenes drawn at random: few triangles, some where the mirror shows them, some that touch it."""
from __future__ import annotations

import numpy as np

from core import TriangleMesh, View
from tests.fuzz.drawing.placing import random_rotation
from tests.inputs import shapes


def _triangle(rng: np.random.Generator) -> tuple:
    return rng.normal(0.0, 1.0, (3, 3)), np.array([[0, 1, 2]])


def _quad(rng: np.random.Generator) -> tuple:
    return shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))[:2]


def _soup(rng: np.random.Generator) -> tuple:
    count = int(rng.integers(2, 15))
    return rng.normal(0.0, 1.0, (3 * count, 3)), np.arange(3 * count).reshape(-1, 3)


def _ball(rng: np.random.Generator) -> tuple:
    return shapes.uv_sphere((0.0, 0.0, 0.0), 0.5, 6, 4)[:2]


def _floor(rng: np.random.Generator) -> tuple:
    cells = int(rng.integers(1, 5))

    def surface(x, y):
        return np.stack([x, y, 0.0 * x], axis=1), np.tile((0.0, 0.0, 1.0), (len(x), 1))
    return shapes.sheet(surface, cells, cells, (-6.0, 6.0), (-6.0, 6.0))[:2]


def _sliver(rng: np.random.Generator) -> tuple:
    width = 10.0 ** -int(rng.integers(1, 10))
    return np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, width, 0.0]]), np.array([[0, 1, 2]])


def _layers(rng: np.random.Generator) -> tuple:
    """Sheets one close behind another."""
    sheets = [shapes.quad((0.0, 0.0, 0.1 * k), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)) for k in range(3)]
    return np.concatenate([one[0] for one in sheets]), np.concatenate([one[1] + 4 * k for k, one in enumerate(sheets)])


PARTS = {"triangle": _triangle, "quad": _quad, "soup": _soup, "ball": _ball, "floor": _floor, "sliver": _sliver,
         "layers": _layers}


def _touching(rng: np.random.Generator, mirror: TriangleMesh) -> tuple:
    """A triangle that stands on an edge of the mirror, or on a corner."""
    positions = mirror.positions[mirror.triangles[rng.integers(len(mirror.triangles))]].copy()
    moved = int(rng.integers(1, 3))
    positions[:moved] += rng.normal(0.0, 1.0, (moved, 3))
    return positions, np.array([[0, 1, 2]])


def _shown_place(rng: np.random.Generator, view: View, mirror: TriangleMesh) -> np.ndarray:
    """A point on a ray that the eye sends to the middle of some triangle of the mirror."""
    one = rng.integers(len(mirror.triangles))
    middle = mirror.positions[mirror.triangles[one]].mean(axis=0)
    incoming, normal = view.directions(middle[None])[0], mirror.face_normals()[one]
    leaving = incoming - 2.0 * (incoming @ normal) * normal
    return middle + rng.uniform(0.3, 4.0) * leaving / max(np.linalg.norm(leaving), 1e-9)


def drawn_scene(rng: np.random.Generator, view: View, mirror: TriangleMesh) -> tuple[list[str], TriangleMesh]:
    """One to four parts, most of them where the mirror may show them, and what they are called."""
    names, parts = [], []
    for _ in range(int(rng.integers(1, 5))):
        kind = str(rng.choice([*PARTS, "touching"]))
        names.append(kind)
        if kind == "touching":
            parts.append(TriangleMesh(*_touching(rng, mirror)))
            continue
        positions, triangles = PARTS[kind](rng)
        shown = rng.random() < 0.6
        place = _shown_place(rng, view, mirror) if shown else rng.normal(0.0, 2.5, 3)
        size = rng.uniform(0.3, 2.0)
        parts.append(TriangleMesh(positions @ random_rotation(rng).T * size + place, triangles))
    return names, TriangleMesh.joined(parts)
