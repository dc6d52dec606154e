"""Rims and corners of what lies apart in a picture of light, which the denoiser does not know to lie apart."""
from __future__ import annotations

import numpy as np

from ...core import breathe
from .. import compat
from ..rendering import continued, grown, sum_around
from .texels import UNTOUCHED

RINGS = 2       # of texels around what is known, that are told by it
DARK = 0.02     # what is darker tells nothing of the light that falls on it
DARKENED = 1.5  # times a texel at the rim of what is denoised: it has lost no more
BLACKENED = 3.0  # the same, where no pattern could be lost by it
BRIGHTENED = 1.15  # times such a texel: it has won no more
AROUND = 8      # texels on either side, of which a corner has few that are known
CORNERED = 0.62  # of those around, up to which a texel lies in a corner: beside a straight rim it is more
WRONG = 2.0     # times a texel in a corner: it is not more wrong, be it too bright or too dark


def spread(picture: np.ndarray, known: np.ndarray) -> np.ndarray:
    """The picture with the texels around what is known as their neighbours in the mean, two rings of them, and all
    others as the mean of what is known."""
    values = np.where(known[..., None], picture, 0.0)
    for _ in range(RINGS):
        breathe()
        weight = sum_around(known.astype(np.float32))
        ring = ~known & (weight > 0.0)
        breathe()
        values[ring] = sum_around(values)[ring] / weight[ring, None]
        known = known | ring
    breathe()
    values[~known] = values[known].mean(axis=0) if known.any() else 0.0
    return values


def with_its_rim(baked: np.ndarray, colours: np.ndarray | None) -> np.ndarray:
    """What was baked (height, width, 4), with the light at its rim as within: the denoiser takes what lies beside for
    black, and darkens two texels for that."""
    known = baked[..., 3] != UNTOUCHED
    # beyond the picture there is nothing either
    solid = ~grown(np.pad(~known, RINGS, constant_values=True), RINGS)[RINGS:-RINGS, RINGS:-RINGS]
    rim = known & ~solid & grown(solid, RINGS)
    if colours is None:
        # hardly anything is darker than it was baked: within may be the shadow of what touches
        inner = spread(baked, solid)
        breathe()
        told = np.clip(inner, baked / BRIGHTENED, BLACKENED * baked)
        breathe()
        return _with_its_corners(np.where(rim[..., None], told, baked), known, solid)
    # the light itself has no pattern, but for gloss
    colours = np.maximum(colours, DARK)
    inner = spread(baked / colours, solid)
    breathe()
    told = np.clip(inner * colours, baked, DARKENED * baked)
    breathe()
    lit = _with_its_corners(np.where(rim[..., None], told, baked) / colours, known, solid) * colours
    breathe()
    # what is not baked is told by its exact number
    return np.where(known[..., None], lit, baked)


def _with_its_corners(light: np.ndarray, known: np.ndarray, solid: np.ndarray) -> np.ndarray:
    """The same with corners as what they end: where black lies on two sides, the denoiser leaves spots, bright or dark.
    """
    if compat.denoises_corners_well():
        return light
    corner = known & grown(solid & (_share_around(known) < CORNERED), RINGS)
    told, reached = continued(light, known & ~corner, corner, AROUND)
    breathe()
    told = np.clip(told, light / WRONG, WRONG * light)
    breathe()
    return np.where((corner & reached)[..., None], told, light)


def _share_around(known: np.ndarray) -> np.ndarray:
    """How much of the square around each texel (height, width) is known."""
    side = 2 * AROUND + 1
    share = np.pad(known, AROUND).astype(np.float32)
    for axis in (0, 1):
        breathe()
        summed = np.insert(share.cumsum(axis=axis), 0, 0.0, axis=axis)
        share = np.take(summed, range(side, summed.shape[axis]), axis) - np.take(
            summed, range(summed.shape[axis] - side), axis)
    return share / side**2
