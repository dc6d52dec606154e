"""Compute the errors of a picture: RMSE, PSNR and relative MSE in linear light, SSIM and FLIP as displayed."""
from __future__ import annotations

import numpy as np

from ...core import breathe
from .picture_filters import filtered, gaussian
from .picture_flip import flip_map, reach

# added to the squared reference, as F. Rousselle et al. do ("Adaptive sampling and reconstruction using greedy error
# minimization", SIGGRAPH Asia 2011), so that black pixels do not divide by nothing
RELATIVE_EPSILON = 0.01
SSIM_SIGMA, SSIM_RADIUS = 1.5, 5        # the window of 11 x 11 pixels of the paper
SSIM_CONSTANTS = (0.01, 0.03)           # K1 and K2 of the paper, for a range of 1
NAMES = ("rmse", "psnr", "psnr_displayed", "relative_mse", "ssim", "flip")


def srgb(linear: np.ndarray) -> np.ndarray:
    """Linear light -> values as an sRGB display takes them (IEC 61966-2-1), at exposure 0, clipped to 0..1."""
    clipped = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    breathe()
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1.0 / 2.4) - 0.055)


def picture_errors(reference: np.ndarray, result: np.ndarray, masks: dict) -> dict:
    """Errors of a picture over each of several sets of pixels.

    Parameters
    ----------
    reference, result : (height, width, 3) float
        Pictures in linear light, Rec. 709 primaries; nothing is clipped for RMSE, PSNR and relative MSE.
    masks : dict of (height, width) bool
        Sets of pixels by name. Filters look beyond the set: what lies outside is seen beside its border.

    Returns
    -------
    errors : dict of dict
        For each set `rmse`, `psnr` (dB, for a peak of 1), `psnr_displayed`, `relative_mse` (mean of difference^2 /
        (reference^2 + 0.01)), `ssim` (Wang et al. 2004, mean over the three channels) and `flip` (LDR-FLIP, Andersson
        et al. 2020, mean); PSNR as displayed, SSIM and FLIP on sRGB values at exposure 0. None where a set is empty,
        and for the PSNR of equal pictures.
    """
    reference, result = (np.asarray(picture, dtype=np.float64) for picture in (reference, result))
    squared = (reference - result) ** 2
    breathe()
    relative = squared / (reference ** 2 + RELATIVE_EPSILON)
    breathe()
    displayed = srgb(reference)
    breathe()
    displayed = (displayed - srgb(result)) ** 2
    breathe()
    structure, perceived = displayed_maps(reference, result)
    errors = {}
    for name, pixels in masks.items():
        if not pixels.any():
            errors[name] = dict.fromkeys(NAMES)
            continue
        breathe()
        rmse = float(np.sqrt(squared[pixels].mean()))
        errors[name] = {"rmse": rmse, "psnr": _decibels(rmse ** 2),
                        "psnr_displayed": _decibels(float(displayed[pixels].mean())),
                        "relative_mse": float(relative[pixels].mean()), "ssim": float(structure[pixels].mean()),
                        "flip": float(perceived[pixels].mean())}
    return errors


def _decibels(squared: float) -> float | None:
    """The PSNR of a mean squared error, for a peak of 1."""
    return float(-10.0 * np.log10(squared)) if squared > 0.0 else None


def displayed_maps(reference: np.ndarray, result: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """SSIM and FLIP (height, width) of two linear pictures as displayed.

    Filters run only where they can meet a difference, as a rule a box round the mirrors.
    """
    structure, perceived = np.ones(reference.shape[:2]), np.zeros(reference.shape[:2])
    differs = (reference != result).any(axis=2)
    if not differs.any():
        return structure, perceived
    radius = max(reach(), SSIM_RADIUS)
    inner, outer, kept = [], [], []
    for axis in (0, 1):
        found = np.flatnonzero(differs.any(axis=1 - axis))
        low, high = max(found[0] - radius, 0), min(found[-1] + 1 + radius, differs.shape[axis])
        # around what is kept, filters need as much again
        start, end = max(low - radius, 0), min(high + radius, differs.shape[axis])
        inner.append(slice(low, high))
        outer.append(slice(start, end))
        kept.append(slice(low - start, high - start))
    displayed = srgb(reference[tuple(outer)]), srgb(result[tuple(outer)])
    structure[tuple(inner)] = ssim_map(*displayed)[tuple(kept)]
    perceived[tuple(inner)] = flip_map(*displayed)[tuple(kept)]
    return structure, perceived


def ssim_map(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Structural similarity (height, width) of two pictures (height, width, channels) with values in 0..1.

    Z. Wang et al., "Image quality assessment: from error visibility to structural similarity", IEEE TIP 13 (2004): a
    gaussian window of sigma 1.5 cut to 11 x 11, population variances; per channel, then averaged. The picture is
    mirrored at its border.
    """
    window = gaussian(SSIM_SIGMA, SSIM_RADIUS)
    window /= window.sum()

    def mean(picture: np.ndarray) -> np.ndarray:
        return filtered(picture, window, window, "symmetric")

    mean_first, mean_second = mean(first), mean(second)
    variance_first = mean(first * first) - mean_first ** 2
    variance_second = mean(second * second) - mean_second ** 2
    covariance = mean(first * second) - mean_first * mean_second
    luminance, contrast = (value ** 2 for value in SSIM_CONSTANTS)
    above = (2.0 * mean_first * mean_second + luminance) * (2.0 * covariance + contrast)
    below = (mean_first ** 2 + mean_second ** 2 + luminance) * (variance_first + variance_second + contrast)
    return (above / below).mean(axis=2)
