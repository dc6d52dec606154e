"""Blocks of texels: each face lies in one, they do not overlap, and what is seen in small places takes few texels."""
from __future__ import annotations

import bpy
import numpy as np
import parts
from lamp_scenes import picture, psnr, scene_of, shine


def spread_faces(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the groups and the corners of 400 small triangles all over a picture, and of two large ones."""
    random = np.random.default_rng(seed)
    small = random.uniform(0.0, 2000.0, (400, 1, 2)) + random.uniform(0.0, 6.0, (400, 3, 2))
    large = np.array([[[0.0, 0.0], [900.0, 0.0], [900.0, 900.0]], [[0.0, 0.0], [900.0, 900.0], [0.0, 900.0]]])
    return np.concatenate((random.integers(0, 4, 400), [9, 9])), np.concatenate((small, large))


def test_blocks_hold_their_faces_and_lie_beside_each_other(room):
    blocks = room("addon.lighting.texel_blocks")
    group, spots = spread_faces(3)
    block, low, made = blocks.blocks_of(group, spots)
    size = blocks.pack(made)
    inside = spots - low[block][:, None]
    assert (inside >= blocks.MARGIN).all()
    assert (inside <= np.array([one.size for one in made])[block][:, None] - blocks.MARGIN).all()
    assert all(len(np.unique(group[block == number])) == 1 for number in np.unique(block))
    taken = np.zeros(size[::-1], dtype=np.int64)
    for one in made:
        (column, row), (width, height) = one.corner, one.size
        taken[row:row + height, column:column + width] += 1
    assert taken.shape == tuple(size[::-1]) and taken.max() == 1
    assert taken.sum() == sum(one.size.prod() for one in made)
    # a box around each of four groups would have 4 million texels; the large faces stay in one block of 910 x 910
    assert len(np.unique(block[-2:])) == 1 and taken.sum() < 1.3 * 910**2


def test_light_goes_on_across_the_borders_of_blocks(blank, room, monkeypatch):
    """Faces sorted into cells of eight texels, far smaller than any that are used, show what they show in one block."""
    wall = scene_of(blank)
    shine(blank.scene)
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], wall)
    parts.generate(tolerance=0.5)
    result = bpy.data.objects["Mirror Reflection"]
    shown = []
    for cells in ((np.inf,), (8.0,)):
        monkeypatch.setattr(room("addon.lighting.texel_blocks"), "CELLS", cells)
        parts.select(result)
        assert bpy.ops.reflection_mesh.light(samples=16) == {"FINISHED"}
        shown.append(picture(room))
    assert psnr(*shown) > 45.0  # measured: 47.0
