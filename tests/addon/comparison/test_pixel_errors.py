"""Displacements, holes, spill and wrong layers of coded pictures, against closed forms."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

SIZE = 64


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    return SimpleNamespace(pixel_errors=room("addon.metrics.pixel_errors"))


def plane_picture(numbers, step=(0.5, 0.25), shear=0.0):
    """A picture of one plane whose point moves by `step` from pixel to pixel."""
    rows, columns = np.mgrid[0:20, 0:30].astype(np.float64)
    position = np.stack([columns * step[0] + shear * rows, rows * step[1], np.full_like(rows, 7.0)], axis=-1)
    return numbers.CodedPicture(np.zeros((20, 30), dtype=np.int64), np.zeros((20, 30), dtype=np.int64), position)


def test_motion_is_the_larger_step_of_both_axes(rooms):
    truth = plane_picture(rooms.pixel_errors, shear=1.2)
    assert np.allclose(rooms.pixel_errors.motion_per_pixel(truth), np.hypot(1.2, 0.25), rtol=1e-12)


def test_motion_does_not_cross_to_another_object(rooms):
    truth = plane_picture(rooms.pixel_errors)
    truth.source[:, 15:] = 1
    truth.position[:, 15:] += 100.0
    assert np.allclose(rooms.pixel_errors.motion_per_pixel(truth), 0.5, rtol=1e-12)


def test_motion_of_a_lone_pixel_is_unknown(rooms):
    truth = plane_picture(rooms.pixel_errors)
    truth.source[5, 5] = 3
    assert np.isnan(rooms.pixel_errors.motion_per_pixel(truth)[5, 5])


def test_a_shift_is_measured_in_pixels(rooms):
    numbers = rooms.pixel_errors
    truth, shown = plane_picture(numbers), plane_picture(numbers)
    shown.position[..., 0] += 0.2
    mirror, bent = np.ones((20, 30), dtype=bool), np.zeros((20, 30), dtype=bool)
    found = numbers.measure(mirror, bent, truth, shown).numbers
    assert found["displacement_px"] == pytest.approx(dict.fromkeys(("median", "p95", "p99", "max"), 0.4))
    assert found["coverage_percent"]["all"] == 0.0
    assert found["measured_pixels"] == 600


def test_each_kind_of_wrong_pixel_is_counted(rooms):
    numbers = rooms.pixel_errors
    truth, shown = plane_picture(numbers), plane_picture(numbers)
    mirror, bent = np.ones((20, 30), dtype=bool), np.zeros((20, 30), dtype=bool)
    mirror[:, :2] = False
    shown.source[:, :1] = numbers.NOTHING       # 20 outside: right; the other 20 outside are spill
    bent[0, 2:7] = True                         # 5 left out
    truth.source[1, 2:6] = numbers.ITSELF       # 4 left out
    shown.source[2, 2:5] = numbers.NOTHING      # 3 holes
    truth.source[3, 2:4] = numbers.NOTHING      # 2 spilt
    shown.source[4, 2] = 9                      # another object, 10 units away: wrong layer
    shown.position[4, 2] += 10.0
    shown.source[5, 2] = 9                      # another object at the same point: a shared edge, no error
    found = numbers.measure(mirror, bent, truth, shown)
    count = 20 * 28 - 5 - 4
    assert (found.hole.sum(), found.spill.sum(), found.wrong_layer.sum()) == (3, 22, 1)
    assert found.numbers["judged_pixels"] == count
    assert found.numbers["coverage_percent"] == pytest.approx(
        {"hole": 300 / count, "spill": 2200 / count, "wrong_layer": 100 / count, "all": 2600 / count})
    assert found.numbers["displacement_px"]["max"] == 0.0


def test_far_off_on_the_same_face_is_displacement_and_not_another_layer(rooms):
    numbers = rooms.pixel_errors
    truth, shown = plane_picture(numbers), plane_picture(numbers)
    shown.position[..., 1] += 4.0
    everywhere = np.ones((20, 30), dtype=bool)
    found = numbers.measure(everywhere, ~everywhere, truth, shown).numbers
    assert found["displacement_px"]["median"] == pytest.approx(8.0)
    assert found["coverage_percent"]["wrong_layer"] == 0.0
