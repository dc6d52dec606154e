"""The picture into which objects are baked: each triangle has room of its own, and objects lie beside one another."""
from __future__ import annotations

import numpy as np
import pytest


def covered(corners: np.ndarray, size: int) -> np.ndarray:
    """Texels (size, size) whose middles lie in a triangle (3, 2)."""
    rows, columns = np.mgrid[:size, :size] + 0.5
    sides = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        sides.append((end[0] - start[0]) * (rows - start[1]) - (end[1] - start[1]) * (columns - start[0]))
    return (np.array(sides) >= 0.0).all(axis=0) | (np.array(sides) <= 0.0).all(axis=0)


def interpolated(picture: np.ndarray, at: np.ndarray) -> np.ndarray:
    """What a texture shows at places (n, k, 2), counted in texels, linearly between their middles."""
    low = np.floor(at - 0.5).astype(int)
    part = at - 0.5 - low
    column, row = (np.clip(np.stack((low[..., axis], low[..., axis] + 1)), 0, len(picture) - 1) for axis in (0, 1))
    across = [(1.0 - part[..., 0]) * picture[line, column[0]] + part[..., 0] * picture[line, column[1]] for line in row]
    return (1.0 - part[..., 1]) * across[0] + part[..., 1] * across[1]


def test_triangles_have_room_of_their_own(room):
    """Against every texel: none is of two triangles, and none is without."""
    atlas = room("addon.baking.texels.atlas")
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(90, 1, 3)) + rng.normal(size=(90, 3, 3)) * np.exp(0.7 * rng.normal(size=(90, 1, 1)))
    corners[:6, 2] = corners[:6, 0] + 1e-4 * rng.normal(size=(6, 3))
    packed = atlas.packed(corners, 5.0)
    owner = np.full((packed.size, packed.size), -1)
    spots = packed.uv.astype(np.float64) * packed.size
    assert spots.min() > 0.0 and spots.max() < packed.size
    for number, triangle in enumerate(spots):
        inside = covered(triangle, packed.size)
        assert inside.sum() >= 3 and (owner[inside] == -1).all()
        owner[inside] = number
    # what one shows, its neighbours in the picture hardly change
    shade = rng.random(len(spots))
    picture = np.full((packed.size, packed.size, 4), -1.0, dtype=np.float32)
    picture[owner >= 0] = shade[owner[owner >= 0], None]
    picture = room("addon.baking.levels").spread(picture, owner >= 0)[..., 0]
    weights = rng.dirichlet((1.0, 1.0, 1.0), size=(len(spots), 40))
    at = np.matmul(weights, spots)
    seen = interpolated(picture, at)
    wrong = np.abs(seen - shade[:, None])
    assert wrong.mean() < 0.01 and wrong[weights.min(axis=2) > 0.25].max() < 0.02
    # as many texels as were asked for, along every side
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    texels = np.linalg.norm(np.roll(spots, -1, axis=1) - spots, axis=2)
    legs = np.sort(lengths, axis=1)[:, :2].max(axis=1)
    assert (np.sort(texels, axis=1)[:, :2].max(axis=1) >= 0.99 * 5.0 * legs).all()


@pytest.mark.parametrize("sizes", [
    [(4, 4), (64, 64), (16, 16), (16, 16), (64, 64), (4, 4), (128, 128), (32, 32)], [(300, 7), (7, 300), (1, 1)],
    [(5, 9)], np.random.default_rng(2).integers(1, 60, (400, 2)).tolist(),
    [(8, 8)] * 300])
def test_pictures_of_objects_lie_beside_one_another(room, sizes):
    sizes = np.array(sizes)
    at, side = room("addon.baking.texels.atlas").arranged(sizes)
    taken = np.zeros((side, side), dtype=int)
    for (column, row), (wide, high) in zip(at, sizes):
        taken[row:row + high, column:column + wide] += 1
    assert taken.max() == 1 and taken.sum() == sizes.prod(axis=1).sum()
    # many together take hardly more room than they need
    assert len(sizes) < 20 or side**2 < 1.25 * taken.sum()
