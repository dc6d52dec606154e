"""From what a render shows to what texels must hold, so that rendering them shows it again.

A render weighs the light within a pixel by its filter; a texture between its texels interpolates linearly. Shown as it
is, the picture would be blurred once more. And pixels on the border of what the texture covers show what lies beside
too.
"""
from __future__ import annotations

from functools import partial

import numpy as np

from ....core import breathe, in_steps
from ...faults import Steps, part
from ...rendering import grown
from .borders import LAMP, SEEN_PARTLY, UNSEEN, brightest, filled, without_what_lies_beside

REACH = 3           # texels around the covered ones that filters and interpolation may ask for
FINE = 512          # places across a pixel at which its filter is summed
DARKEST = 0.1       # of a pixel, its texel at first, where the exact one would be below zero; and of one round earlier
ROUNDS = 24         # of bringing texels nearer
FASTEST = 0.99      # of the last step, by which a round begins farther along
LEAST_WEIGHT = 1e-5
AROUND = 8          # texels that one that is brought nearer reaches
LAMP_RIM = 3        # texels from which on the inside of a lamp is as bright as it is
INSIDE_LAMPS = 8.0  # times white, nearer their rims
SHARPENING = "Sharpening the light"
LEAST_RESPONSE = 0.2  # of a wave that a wide filter hardly lets through no more is brought back


def texels_of(light: np.ndarray, coverage: np.ndarray, kernel: np.ndarray, white: float = np.inf,
              opacity: np.ndarray | None = None, faces: str = "ALL") -> Steps[np.ndarray]:
    """The texels whose picture is `light` where results cover it; yields (fraction, stage).

    Parameters
    ----------
    light : (height, width, 3) float32
        What is seen, through the picture's filter.
    coverage : (height, width) float32
        The part of each pixel that results cover, by the same filter.
    kernel : (k,) float64
        As `pixel_kernel` gives it.
    white : float
        From which on light looks white. Around brighter lamps texels would have to be below zero.
    opacity : (height, width) float32, optional
        The part of each pixel that anything covers which is in `light`; 1 where it is not given.
    faces : {'ALL', 'MATTE', 'SHINING'}
        Which are covered: of matte ones alone what covers no pixel well is not told from what all around show of it,
        for that may be a lamp; and what shines is as bright as it is, be it thinner than a pixel.

    Returns
    -------
    texels : (height, width, 3) float32, zero farther than `REACH` from what is covered.
    """
    yield 0.0, SHARPENING
    steps = in_steps(partial(_texels, light, coverage, kernel, white, opacity, faces))
    return (yield from part(steps, 0.0, 1.0, SHARPENING))


def is_overexposed(light: np.ndarray, coverage: np.ndarray, white: float) -> bool:
    """Whether faces with a `coverage` (height, width) are brighter than white by light (height, width, 3), be it that
    they cover no pixel whole."""
    share = np.where(coverage > SEEN_PARTLY, coverage, 1.0)[..., None]
    return bool((light > white * share)[coverage > UNSEEN].any())


def beside_lamps(coverage: np.ndarray, shining: np.ndarray, light: np.ndarray, white: float) -> np.ndarray:
    """What of a `coverage` (height, width) is left without the part that faces that are `shining` have in it. What
    they reach, and what they may reach unnoticed, since few samples fall where the filter ends, counts as hardly
    covered where by `light` (height, width, 3) they are many times as bright as paper, which is `white`: it is shown as
    what lies around it, for a hundredth of a lamp is brighter. What is less bright can be taken away."""
    lamps = brightest(np.where(shining > UNSEEN, light.max(axis=2), 0.0)) > LAMP * white
    return np.minimum(coverage - shining, np.where(grown(shining > 0.0, 1) & lamps, SEEN_PARTLY, 1.0)).clip(0.0)


def _texels(light: np.ndarray, coverage: np.ndarray, kernel: np.ndarray, white: float,
            opacity: np.ndarray | None, faces: str) -> np.ndarray:
    needed = grown(coverage > 0.0, REACH)
    whole = np.ones(coverage.shape) if opacity is None else opacity.astype(np.float64)
    alone, known = without_what_lies_beside(light.astype(np.float64), coverage.astype(np.float64), whole,
                                            len(kernel) // 2, faces != "MATTE",
                                            min(white, LAMP) if faces != "SHINING" else np.inf)
    filtered = filled(alone, known, needed)
    # what is white in a pixel that is covered in part is brighter by itself
    sharp = _sharpened(filtered, kernel, (white / coverage.clip(SEEN_PARTLY, 1.0))[..., None])
    breathe()
    # inside a lamp, from where it does not reach what is beside, it is as bright as it is
    lamp = ~grown(filtered < white, LAMP_RIM)
    breathe()
    sharp = np.where(lamp, filtered, sharp)
    breathe()
    return np.where(needed[..., None], sharp, 0.0).astype(np.float32)


def pixel_kernel(kind: str, width: float) -> np.ndarray:
    """Weights (k,) with which texels along a row, one a pixel and interpolated linearly, make a pixel.

    Parameters
    ----------
    kind : str
        Of Cycles' filters BOX, GAUSSIAN, BLACKMAN_HARRIS.
    width : float
        Of the filter, in pixels.
    """
    at = (np.arange(FINE) + 0.5) / FINE - 0.5
    if kind == "GAUSSIAN":
        weight = np.exp(-2.0 * (6.0 * at) ** 2)
    elif kind == "BLACKMAN_HARRIS":
        turn = 2.0 * np.pi * (at + 0.5)
        weight = 0.35875 - 0.48829 * np.cos(turn) + 0.14128 * np.cos(2.0 * turn) - 0.01168 * np.cos(3.0 * turn)
    else:
        weight = np.ones(FINE)
    # how far Cycles lets its filters reach (intern/cycles/scene/film.cpp)
    width *= {"GAUSSIAN": 3.0, "BLACKMAN_HARRIS": 2.0}.get(kind, 1.0)
    half = int(np.ceil(0.5 * width + 1.0))
    tents = np.maximum(1.0 - np.abs(width * at - np.arange(-half, half + 1)[:, None]), 0.0)
    return tents @ (weight / weight.sum())


def _unfiltered(picture: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """What the kernel, along rows and columns, makes `picture` of."""
    height, width, channels = picture.shape
    columns = width + 4 * REACH
    through_rows, through = _response(kernel, height + 4 * REACH)[:, None], _response(kernel, columns)
    found = np.empty_like(picture)
    for channel in range(channels):
        waves = np.fft.rfft(np.pad(picture[..., channel], 2 * REACH, mode="edge"), axis=1) / through[:columns // 2 + 1]
        breathe()
        waves = np.fft.fft(waves, axis=0) / through_rows
        breathe()
        waves = np.fft.ifft(waves, axis=0)[2 * REACH:][:height]
        breathe()
        found[..., channel] = np.fft.irfft(waves, n=columns, axis=1)[:, 2 * REACH:][:, :width]
        breathe()
    return found


def _sharpened(picture: np.ndarray, kernel: np.ndarray, white: np.ndarray) -> np.ndarray:
    """Texels, none below zero, that show the picture, and something white where that is brighter than what is `white`
    (height, width, 1) in each pixel."""
    capped = np.minimum(picture, white)
    breathe()
    exact = _unfiltered(capped, kernel)
    breathe()
    first = np.maximum(exact, DARKEST * capped)
    breathe()
    bright = picture >= white
    doubtful = np.flatnonzero((bright | (exact < first)).any(axis=2))
    breathe()
    if not len(doubtful):
        return exact
    row, column = np.divmod(doubtful, picture.shape[1])
    around = tuple(slice(max(side.min() - AROUND, 0), side.max() + AROUND + 1) for side in (row, column))
    # what is brighter inside lets lamps' borders be darker, and fall off as fast as they should
    inside = ~grown(~bright, 1)
    breathe()
    for row in np.flatnonzero(bright.any(axis=(1, 2))):
        breathe()
        lit = np.where(inside[row], np.minimum(picture[row], INSIDE_LAMPS * white[row]),
                       np.maximum(first[row], white[row]))
        first[row, bright[row]] = lit[bright[row]]
    first[around] = _brightened(first[around], capped[around], kernel, white[around])
    return first


def _brightened(texels: np.ndarray, picture: np.ndarray, kernel: np.ndarray, white: np.ndarray) -> np.ndarray:
    """Texels that show the picture more nearly without going below zero, as they would have to around lamps; what is
    to be white may be whiter.

    W. H. Richardson, "Bayesian-Based Iterative Method of Image Restoration", JOSA 1972; L. B. Lucy, "An iterative
    technique for the rectification of observed distributions", AJ 1974. Each round begins farther along the way that
    the last ones went, which makes as much of 24 as of 150: D. S. C. Biggs, M. Andrews, "Acceleration of iterative
    image restoration algorithms", Applied Optics 1997.
    """
    earlier, way, way_before = texels, None, None
    for _ in range(ROUNDS):
        guess = texels
        if way is not None and way_before is not None:
            pace = np.clip(np.vdot(way, way_before) / max(np.vdot(way_before, way_before), 1e-30), 0.0, FASTEST)
            breathe()
            guess = texels + pace * (texels - earlier)
            breathe()
            # what is zero once stays so
            guess = np.maximum(guess, DARKEST * texels)
            breathe()
        shown = np.maximum(_filtered(guess, kernel), 1e-30)
        wanted = np.where(picture < white, picture, np.maximum(shown, white)) / shown
        breathe()
        earlier, texels = texels, guess * _filtered(wanted, kernel)
        breathe()
        way, way_before = texels - guess, way
        breathe()
    return texels


def _filtered(texels: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """What texels show, along rows and columns."""
    half = len(kernel) // 2
    for axis in (0, 1):
        ends = [(0, 0)] * 3
        ends[axis] = (half, half)
        around = np.pad(texels, ends, mode="edge")
        count = texels.shape[axis]
        texels = np.zeros_like(texels)
        for step, weight in enumerate(kernel):
            if weight > LEAST_WEIGHT:
                texels += weight * (around[step:step + count] if axis == 0 else around[:, step:step + count])
                breathe()
    return texels


def _response(kernel: np.ndarray, count: int) -> np.ndarray:
    """How much the kernel lets through of each of `count` waves."""
    step = np.arange(len(kernel)) - len(kernel) // 2
    response = np.cos(2.0 * np.pi * np.outer(np.arange(count) / count, step)) @ kernel
    return np.maximum(response, LEAST_RESPONSE)
