"""OpenEXR pictures, as Blender reads them."""
from __future__ import annotations

import bpy
import numpy as np
import pytest

RANDOM = np.random.default_rng(11)


def pictured(height: int, width: int, channels: int = 3, scale: float = 1.0) -> np.ndarray:
    """Noise on a slope, black in its lower half; the first row is the lowest."""
    y, x = np.mgrid[:height, :width]
    light = scale * (0.1 + (x + 2.0 * y) / (width + height))[..., None] * RANDOM.uniform(0.5, 1.5, (1, 1, channels))
    light *= RANDOM.uniform(0.9, 1.1, light.shape)
    light[:height // 2] = 0.0
    return light.astype(np.float32)


def read_back(packed: bytes, path) -> np.ndarray:
    path.write_bytes(packed)
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name, image.alpha_mode = "Non-Color", "CHANNEL_PACKED"
    values = np.array(image.pixels[:], dtype=np.float32).reshape(*tuple(image.size)[::-1], -1)
    bpy.data.images.remove(image)
    return values


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (16, 8), (17, 33), (100, 7)])
@pytest.mark.parametrize("channels", [3, 4])
def test_blender_reads_what_was_written(room, tmp_path, size, channels):
    """To the half of a last bit; single lines and blocks that are not full too."""
    light, files = pictured(*size, channels), room("addon.files")
    packed = files.open_exr(light)
    found = read_back(packed, tmp_path / "light.exr")
    assert found.shape == (*size, 4)
    assert (np.abs(found[..., :channels] - light) <= 2.0**-11 * light).all()
    assert channels == 4 or (found[..., 3] == 1.0).all()
    assert files.is_whole(str(tmp_path / "light.exr"))
    for cut in (1, len(packed) // 2):
        (tmp_path / "light.exr").write_bytes(packed[:-cut])
        assert not files.is_whole(str(tmp_path / "light.exr"))


@pytest.mark.parametrize("scale", [1e5, 1e-5, 1e-30])
def test_light_beyond_half_precision_is_exact(room, tmp_path, scale):
    light = pictured(40, 30, scale=scale)
    found = read_back(room("addon.files").open_exr(light), tmp_path / "light.exr")
    assert np.array_equal(found[..., :3], light)


def test_what_is_empty_takes_no_room(room):
    """Half of it is: that takes a hundredth, and the rest two bytes for each number at most."""
    light = pictured(256, 256)
    assert len(room("addon.files").open_exr(light)) < 1.02 * light[128:].size * 2
