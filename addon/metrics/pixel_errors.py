"""Coded pictures -> numbers: how far a reflection mesh is from what a ray tracer shows, in pixels and in coverage."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import breathe

NOTHING = -1    # the ray meets no diffuse object
ITSELF = -2     # the reflected ray meets a mirror
OTHER_SURFACE = 2.0     # displacement in pixels from which another face counts as another surface


@dataclass(frozen=True)
class CodedPicture:
    """Object, face and position at the centre of every pixel of a picture.

    Attributes
    ----------
    source : (height, width) int64
        Index of the diffuse object, `NOTHING` or `ITSELF`.
    face : (height, width) int64
        Its polygon, -1 if unknown.
    position : (height, width, 3) float64
        The diffuse point, in world space and scene units. Undefined if `source` is negative.
    """

    source: np.ndarray
    face: np.ndarray
    position: np.ndarray


@dataclass(frozen=True)
class Measurement:
    """Errors of a reflection over the mirror's visible pixels.

    Attributes
    ----------
    displacement : (height, width) float64
        |point shown - true point| in units of that point's motion per pixel; NaN where it is not measured.
    mirror, judged, hole, spill, wrong_layer : (height, width) bool
    numbers : dict
        Counts of pixels, displacement in pixels, coverage in per cent of the judged pixels; None without such pixels.
    """

    displacement: np.ndarray
    mirror: np.ndarray
    judged: np.ndarray
    hole: np.ndarray
    spill: np.ndarray
    wrong_layer: np.ndarray
    numbers: dict


def motion_per_pixel(truth: CodedPicture) -> np.ndarray:
    """Return the distance (height, width), in scene units, between the true points of neighbouring pixels.

    It is the larger of the distances along both axes. Along each axis it is the smaller of the distances to either
    side, since the larger may cross to another surface of the same object. NaN if no neighbour along an axis shows the
    same object, and if the distance is zero.
    """
    seen = truth.source >= 0
    axes = []
    for axis in (0, 1):
        breathe()
        step = np.diff(truth.position, axis=axis)
        breathe()
        step = np.linalg.norm(step, axis=2)
        breathe()
        same = np.diff(truth.source, axis=axis) == 0
        step = np.where(same, step, np.inf)
        pad = [(0, 0), (0, 0)]
        sides = []
        for side in ((1, 0), (0, 1)):
            breathe()
            pad[axis] = side
            sides.append(np.pad(step, pad, constant_values=np.inf))
        axes.append(np.minimum(*sides))
    motion = np.maximum(*axes)
    return np.where(seen & np.isfinite(motion) & (motion > 0.0), motion, np.nan)


def measure(mirror: np.ndarray, bent: np.ndarray, truth: CodedPicture, shown: CodedPicture) -> Measurement:
    """Compare what the reflection mesh shows with the truth.

    Parameters
    ----------
    mirror : (height, width) bool
        Pixels in which the eye sees a mirror.
    bent : (height, width) bool
        Pixels where the ray tracer bends the shading normal; left out, like those where a mirror sees a mirror.
    truth, shown : CodedPicture
        The ray traced picture, and the one with the reflection mesh before a mirror that reflects nothing.

    Notes
    -----
    hole: the truth shows the scene, the mesh nothing. spill: the reverse, or the mesh reaches outside the mirror.
    wrong layer: another face, and displaced by more than two pixels; such pixels do not count in the displacement.
    """
    judged = mirror & ~bent & (truth.source != ITSELF)
    true, drawn = judged & (truth.source >= 0), shown.source >= 0
    hole = true & ~drawn
    spill = drawn & ((judged & (truth.source == NOTHING)) | ~mirror)
    motion = motion_per_pixel(truth)
    breathe()
    displacement = np.full(mirror.shape, np.nan)
    both = true & drawn
    away = shown.position[both]
    breathe()
    away -= truth.position[both]
    breathe()
    displacement[both] = np.linalg.norm(away, axis=1) / motion[both]
    breathe()
    unknown = (shown.face < 0) | (truth.face < 0)
    elsewhere = (shown.source != truth.source) | ((shown.face != truth.face) & ~unknown)
    # without a neighbour there is no scale: another face is then taken for another surface
    wrong = both & elsewhere & ~(displacement <= OTHER_SURFACE)
    displacement[wrong] = np.nan
    breathe()
    measured = displacement[np.isfinite(displacement)]
    count = int(judged.sum())
    share = percentages({"hole": int(hole.sum()), "spill": int(spill.sum()), "wrong_layer": int(wrong.sum())}, count)
    breathe()
    numbers = {
        "mirror_pixels": int(mirror.sum()), "judged_pixels": count, "measured_pixels": len(measured),
        "left_out_mirror_in_mirror": int((mirror & (truth.source == ITSELF)).sum()),
        "left_out_bent_normal": int((mirror & bent & (truth.source != ITSELF)).sum()),
        "displacement_px": _distribution(measured),
        "coverage_percent": share,
    }
    return Measurement(displacement, mirror, judged, hole, spill, wrong, numbers)


def without_packing(mirror: np.ndarray, bent: np.ndarray, packed: CodedPicture, exact: CodedPicture,
                    shown: CodedPicture) -> dict:
    """The reflection's own error, told apart from what rounded normals do to the ray tracer.

    Parameters
    ----------
    packed, exact : CodedPicture
        The truth with the ray tracer's rounded normals, and with normals as they are.

    Returns
    -------
    numbers : dict
        `displacement_px` and `coverage_percent` against the exact truth, and `shift_px`: how far rounding moves the
        truth itself, in units of the exact truth's motion per pixel.
    """
    numbers = measure(mirror, bent, exact, shown).numbers
    same = mirror & ~bent & (exact.source >= 0) & (exact.source == packed.source) & (exact.face == packed.face)
    shift = np.linalg.norm(packed.position - exact.position, axis=2) / motion_per_pixel(exact)
    shift = shift[same & np.isfinite(shift)]
    return {"displacement_px": numbers["displacement_px"], "coverage_percent": numbers["coverage_percent"],
            "shift_px": _distribution(shift)}


def percentages(counts: dict[str, int], total: int) -> dict[str, float | None]:
    """Return counts in per cent of a total by name, with their sum as `all`; None if the total is zero."""
    counts = {**counts, "all": sum(counts.values())}
    return {name: 100.0 * count / total if total else None for name, count in counts.items()}


def _distribution(values: np.ndarray) -> dict:
    if not len(values):
        return {"median": None, "p95": None, "p99": None, "max": None}
    median, p95, p99 = np.percentile(values, (50, 95, 99))
    return {"median": float(median), "p95": float(p95), "p99": float(p99), "max": float(values.max())}
