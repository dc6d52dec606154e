"""LDR-FLIP: the difference that a viewer sees who flips between two pictures.

P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference Evaluator
for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020; the symbols are those of the paper.
"""
from __future__ import annotations

import math

import numpy as np

from ...core import breathe
from .picture_filters import filtered, gaussian

# a viewer 0.7 m before a display 0.7 m wide with 3840 pixels, as the paper assumes
PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * math.pi / 180.0
# the eye's sensitivity to contrast as sums of gaussians, (a, b) each: achromatic, red-green, blue-yellow
SENSITIVITY = (((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))
COLOUR_EXPONENT, CUT, CUT_VALUE = 0.7, 0.4, 0.95        # q_c, p_c, p_t
FEATURE_WIDTH, FEATURE_EXPONENT = 0.082, 0.5            # w in degrees, q_f
# linear sRGB -> XYZ, from the chromaticities of sRGB, in the paper's fractions
TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                   [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                   [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(axis=1)


def flip_map(reference: np.ndarray, test: np.ndarray, pixels_per_degree: float = PIXELS_PER_DEGREE) -> np.ndarray:
    """FLIP (height, width) in 0..1 of two pictures (height, width, 3) of sRGB values in 0..1."""
    first, second = (_opponent(_linear(np.asarray(picture, dtype=np.float64))) for picture in (reference, test))
    colour = _colour_difference(_seen(first, pixels_per_degree), _seen(second, pixels_per_degree))
    feature = _feature_difference(first[..., 0], second[..., 0], pixels_per_degree)
    return colour ** (1.0 - feature)


def reach(pixels_per_degree: float = PIXELS_PER_DEGREE) -> int:
    """Return the radius of FLIP's widest filter, in pixels."""
    widest = max(b for channel in SENSITIVITY for _, b in channel)
    return math.ceil(3.0 * math.sqrt(widest / (2.0 * math.pi ** 2)) * pixels_per_degree)


def _colour_difference(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """HyAB distance of two filtered linear pictures, in 0..1: small ones are spread out, large ones compressed."""
    distance = _hyab(_hunt_lab(first), _hunt_lab(second)) ** COLOUR_EXPONENT
    green, blue = _hunt_lab(np.array([[0.0, 1.0, 0.0]])), _hunt_lab(np.array([[0.0, 0.0, 1.0]]))
    largest = float(_hyab(green, blue)[0]) ** COLOUR_EXPONENT
    cut = CUT * largest
    return np.where(distance < cut, CUT_VALUE / cut * distance,
                    CUT_VALUE + (distance - cut) / (largest - cut) * (1.0 - CUT_VALUE))


def _feature_difference(first: np.ndarray, second: np.ndarray, pixels_per_degree: float) -> np.ndarray:
    """Difference of edges and points in two achromatic pictures (height, width), in 0..1."""
    sigma = 0.5 * FEATURE_WIDTH * pixels_per_degree
    radius = math.ceil(3.0 * sigma)
    smooth = gaussian(sigma, radius)
    offsets = np.arange(-radius, radius + 1, dtype=np.float64)
    detectors = [_balanced(-offsets * smooth), _balanced((offsets ** 2 / sigma ** 2 - 1.0) * smooth)]
    smooth /= smooth.sum()
    # the achromatic channel of the opponent space, brought to 0..1
    first, second = (first + 16.0) / 116.0, (second + 16.0) / 116.0
    differences = []
    for detector in detectors:
        strengths = [np.hypot(filtered(picture, smooth, detector, "edge"), filtered(picture, detector, smooth, "edge"))
                     for picture in (first, second)]
        differences.append(np.abs(strengths[0] - strengths[1]))
    return np.clip((np.maximum(*differences) / math.sqrt(2.0)) ** FEATURE_EXPONENT, 0.0, 1.0)


def _balanced(kernel: np.ndarray) -> np.ndarray:
    """Positive weights scaled to a sum of 1, negative ones to -1."""
    return np.where(kernel > 0.0, kernel / kernel[kernel > 0.0].sum(), kernel / -kernel[kernel < 0.0].sum())


def _seen(opponent: np.ndarray, pixels_per_degree: float) -> np.ndarray:
    """Filter a picture (height, width, 3) in YyCxCz by the eye's contrast sensitivity. Return linear sRGB in 0..1."""
    radius = reach(pixels_per_degree)
    channels = []
    for index, terms in enumerate(SENSITIVITY):
        total, weight = 0.0, 0.0
        for a, b in terms:
            # exp(-pi^2 x^2 / b) with x in degrees
            kernel = gaussian(math.sqrt(b / 2.0) / math.pi * pixels_per_degree, radius)
            share = a * math.sqrt(math.pi / b)
            total = total + share * filtered(opponent[..., index], kernel, kernel, "edge")
            weight += share * kernel.sum() ** 2
        channels.append(total / weight)
    return np.clip(_from_opponent(np.stack(channels, axis=-1)), 0.0, 1.0)


def _linear(srgb: np.ndarray) -> np.ndarray:
    breathe()
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _opponent(linear: np.ndarray) -> np.ndarray:
    """Linear sRGB -> YyCxCz, a linear version of CIELAB."""
    breathe()
    x, y, z = np.moveaxis(linear @ TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def _from_opponent(opponent: np.ndarray) -> np.ndarray:
    breathe()
    y = (opponent[..., 0] + 16.0) / 116.0
    xyz = np.stack([y + opponent[..., 1] / 500.0, y, y - opponent[..., 2] / 200.0], axis=-1)
    breathe()
    return (xyz * WHITE) @ np.linalg.inv(TO_XYZ).T


def _hunt_lab(linear: np.ndarray) -> np.ndarray:
    """Linear sRGB -> CIELAB, with less colour where it is dark (the Hunt effect)."""
    ratio = linear @ TO_XYZ.T / WHITE
    breathe()
    delta = 6.0 / 29.0
    root = np.where(ratio > delta ** 3, np.cbrt(ratio), ratio / (3.0 * delta ** 2) + 4.0 / 29.0)
    breathe()
    x, y, z = np.moveaxis(root, -1, 0)
    lightness = 116.0 * y - 16.0
    return np.stack([lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)], axis=-1)


def _hyab(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    breathe()
    difference = first - second
    return np.abs(difference[..., 0]) + np.hypot(difference[..., 1], difference[..., 2])
