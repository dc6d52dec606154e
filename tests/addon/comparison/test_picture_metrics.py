"""Errors of pictures: closed forms, and the reference implementations where they are installed."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

SIZE = (96, 131)
EVERYWHERE = np.ones(SIZE, dtype=bool)


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    names = ("metrics.picture_metrics", "metrics.picture_flip", "metrics.picture_filters")
    return SimpleNamespace(**{name.rpartition(".")[2]: room(f"addon.{name}") for name in names})


def painted(seed: int = 3) -> np.ndarray:
    """A display-referred picture with smooth parts, hard edges, fine lines and saturated colours."""
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[0:SIZE[0], 0:SIZE[1]] / 40.0
    picture = np.stack([0.5 + 0.5 * np.sin(columns + channel) * np.cos(rows * (1 + channel)) for channel in range(3)],
                       axis=-1)
    picture[20:50, 30:80] = (1.0, 0.1, 0.05)
    picture[35:70, 60:110] = (0.0, 0.9, 0.2)
    picture[::7, 90:] = (0.05, 0.1, 1.0)
    picture[60:, :30] = rng.random((SIZE[0] - 60, 30, 3))
    return np.clip(picture, 0.0, 1.0)


def changed() -> list:
    """The painted picture shifted, with noise, turned over, darker, and as it is."""
    picture, rng = painted(), np.random.default_rng(4)
    return [np.roll(picture, 1, axis=1), np.clip(picture + 0.1 * rng.standard_normal(picture.shape), 0.0, 1.0),
            picture[::-1].copy(), 0.6 * picture, picture.copy()]


def test_the_names_are_the_known_ones(rooms):
    found = rooms.picture_metrics.picture_errors(painted(), painted(5), {"here": EVERYWHERE, "nowhere": ~EVERYWHERE})
    assert set(found) == {"here", "nowhere"}
    assert tuple(found["here"]) == rooms.picture_metrics.NAMES
    assert found["nowhere"] == dict.fromkeys(rooms.picture_metrics.NAMES)


def test_one_grey_before_another_has_closed_forms(rooms):
    """In linear light 0.4 and 0.5; with both pictures even, SSIM is its luminance term alone."""
    reference, result = np.full((*SIZE, 3), 0.4), np.full((*SIZE, 3), 0.5)
    found = rooms.picture_metrics.picture_errors(reference, result, {"all": EVERYWHERE})["all"]
    shown = [1.055 * grey ** (1 / 2.4) - 0.055 for grey in (0.4, 0.5)]
    assert found["rmse"] == pytest.approx(0.1)
    assert found["psnr"] == pytest.approx(20.0)
    assert found["relative_mse"] == pytest.approx(0.01 / (0.16 + 0.01))
    assert found["ssim"] == pytest.approx((2 * shown[0] * shown[1] + 1e-4) / (shown[0] ** 2 + shown[1] ** 2 + 1e-4))


def test_flip_of_two_greys_follows_the_lightness(rooms):
    """Greys have no chroma and no features: FLIP is the redistributed difference of CIE lightness to the power 0.7."""
    first, second = np.full((*SIZE, 3), 0.4), np.full((*SIZE, 3), 0.5)
    lightness = [116.0 * np.cbrt(((grey + 0.055) / 1.055) ** 2.4) - 16.0 for grey in (0.4, 0.5)]
    # the largest distance is that of sRGB's green from its blue, with the Hunt effect, after the paper's section 4.1.3
    lab = {"green": (87.7370, -86.1846, 83.1812), "blue": (32.3026, 79.1967, -107.8637)}
    hunt = {name: (light, 0.01 * light * a, 0.01 * light * b) for name, (light, a, b) in lab.items()}
    apart = np.array(hunt["green"]) - hunt["blue"]
    largest = (abs(apart[0]) + np.hypot(apart[1], apart[2])) ** 0.7
    expected = 0.95 / (0.4 * largest) * abs(lightness[0] - lightness[1]) ** 0.7
    assert rooms.picture_flip.flip_map(first, second) == pytest.approx(np.full(SIZE, expected), rel=2e-3)


def test_equal_pictures_have_no_error(rooms):
    found = rooms.picture_metrics.picture_errors(painted(), painted(), {"all": EVERYWHERE})["all"]
    assert found == {"rmse": 0.0, "psnr": None, "psnr_displayed": None, "relative_mse": 0.0,
                     "ssim": pytest.approx(1.0, abs=1e-12), "flip": 0.0}


def test_only_pixels_of_the_set_count(rooms):
    reference, result = painted(), painted()
    result[:10, :10] = 0.0
    far = EVERYWHERE.copy()
    far[:40, :40] = False       # farther than any filter reaches
    errors = rooms.picture_metrics.picture_errors(reference, result, {"near": ~far, "far": far})
    assert errors["near"]["rmse"] > 0.05 and errors["near"]["flip"] > 0.02 and errors["near"]["ssim"] < 0.95
    assert errors["far"]["rmse"] == 0.0 and errors["far"]["flip"] < 1e-12
    assert errors["far"]["ssim"] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("place", [(0, 0), (48, 70), (95, 130)])
def test_only_the_surroundings_of_differences_are_filtered(rooms, place):
    """The same maps as over the whole picture, for a difference in corners and in the middle."""
    reference, result = painted(), painted()
    result[place] = 1.0 - result[place]
    structure, perceived = rooms.picture_metrics.displayed_maps(reference, result)
    shown = rooms.picture_metrics.srgb(reference), rooms.picture_metrics.srgb(result)
    np.testing.assert_allclose(structure, rooms.picture_metrics.ssim_map(*shown), atol=1e-12)
    np.testing.assert_allclose(perceived, rooms.picture_flip.flip_map(*shown), atol=1e-6)
    assert (perceived > 1e-3).sum() > 20


def test_bright_light_counts_in_linear_light_and_is_clipped_on_the_display(rooms):
    reference, result = np.full((*SIZE, 3), 3.0), np.full((*SIZE, 3), 5.0)
    found = rooms.picture_metrics.picture_errors(reference, result, {"all": EVERYWHERE})["all"]
    assert found["rmse"] == pytest.approx(2.0)
    assert found["psnr"] == pytest.approx(-20.0 * np.log10(2.0))
    assert found["flip"] == 0.0 and found["ssim"] == pytest.approx(1.0)


def test_a_filter_is_the_sum_over_its_window(rooms):
    rng = np.random.default_rng(6)
    picture, down, across = rng.random((9, 8)), rng.random(5), rng.random(3)
    padded = np.pad(picture, ((2, 2), (1, 1)), mode="edge")
    expected = [[np.sum(padded[row:row + 5, column:column + 3] * np.outer(down, across)) for column in range(8)]
                for row in range(9)]
    assert rooms.picture_filters.filtered(picture, down, across, "edge") == pytest.approx(np.array(expected), rel=1e-12)


def test_rmse_and_psnr_agree_with_scikit_image(rooms):
    metrics = pytest.importorskip("skimage.metrics")
    for result in changed()[:-1]:
        found = rooms.picture_metrics.picture_errors(painted(), result, {"all": EVERYWHERE})["all"]
        assert found["rmse"] ** 2 == pytest.approx(metrics.mean_squared_error(painted(), result), rel=1e-12)
        assert found["psnr"] == pytest.approx(metrics.peak_signal_noise_ratio(painted(), result, data_range=1.0),
                                              rel=1e-12)


@pytest.mark.thorough
def test_ssim_agrees_with_scikit_image_in_every_pixel(rooms):
    metrics = pytest.importorskip("skimage.metrics")
    for result in changed():
        _, expected = metrics.structural_similarity(
            painted(), result, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1.0,
            channel_axis=2, full=True)
        # both in float64: only the order of the sums differs
        assert rooms.picture_metrics.ssim_map(painted(), result) == pytest.approx(expected.mean(axis=2), abs=1e-10)


@pytest.mark.thorough
def test_flip_agrees_with_its_authors_implementation_in_every_pixel(rooms):
    evaluator = pytest.importorskip("flip_evaluator")
    for result in changed():
        expected, mean, _ = evaluator.evaluate(painted().astype(np.float32), result.astype(np.float32), "LDR",
                                               applyMagma=False)
        found = rooms.picture_flip.flip_map(painted(), result)
        # theirs is in float32, and the square root of the features' difference enlarges its rounding
        assert found == pytest.approx(expected.reshape(found.shape), abs=1e-4)
        assert found.mean() == pytest.approx(mean, abs=1e-5)
