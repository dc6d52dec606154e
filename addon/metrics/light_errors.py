"""Compare the light on surfaces with traced rays: its total flux, and its irradiance over small squares."""
from __future__ import annotations

import numpy as np

from ...core import breathe
from ...core.geometry import areas, cross, dot
from ...core.polygons import ConvexPolygons, Line

BINS = 128  # squares along the longest side of the box round what is lit
BESIDE = 8  # squares round that box
AT_ONCE = 1 << 17
TOUCHING = 1e-6  # of a square: what reaches less far into it only touches it


class Squares:
    """A lattice of squares, seen along the axis that a surface faces most.

    Parameters
    ----------
    low, high : (3,) float64
        The box round what is lit.
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, bins: int = BINS) -> None:
        self.low, self.step = low, max(float((high - low).max()) / bins, 1e-300)
        self.side = bins + 2 * BESIDE + 1

    def names(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """One number (n,) for the square that each of the points (n, 3) lies in, on surfaces with normals (n, 3)."""
        axis = np.argmax(np.abs(normals), axis=1)
        cell = np.floor((points - self.low) / self.step).astype(np.int64)
        cell[np.arange(len(axis)), axis] = 0
        # a lifted place may lie a little beside the box
        cell = np.clip(cell + BESIDE, 0, self.side - 1)
        return ((axis * self.side + cell[:, 0]) * self.side + cell[:, 1]) * self.side + cell[:, 2]


def light_in_squares(corners: np.ndarray, irradiance: np.ndarray, normals: np.ndarray,
                     squares: Squares) -> tuple[np.ndarray, np.ndarray]:
    """The squares that faces light, and the flux of each, exact: faces are cut along the squares' sides.

    Parameters
    ----------
    corners : (m, 3, 3) float64
    irradiance : (m, 3) float64
        At the corners, linear in between.
    normals : (m, 3) float64
        Of the surface that each face lies on.
    """
    across = _across(corners, normals, squares)
    reach = np.ptp(across, axis=1) + 1.0
    breathe()
    area, found = areas(corners), []
    for part in _runs(reach.prod(axis=1)):
        breathe()
        face, weights = _cut(across[part])
        breathe()
        face += part.start
        middle = weights.mean(axis=1)
        share = np.abs(dot(weights[:, 0], cross(weights[:, 1], weights[:, 2])))
        light = share * area[face] * (middle.T * irradiance[face]).sum(axis=1)
        breathe()
        names = squares.names(np.einsum("kn,nkc->nc", middle, corners[face]), normals[face])
        breathe()
        found.append(added(names, light))
    return added(*(np.concatenate(one) for one in zip(*found)))


def _across(corners: np.ndarray, normals: np.ndarray, squares: Squares) -> np.ndarray:
    """Corners (m, 3, 2) in sides of squares, along the two axes in which the squares of their faces lie."""
    axes = np.array(((1, 2), (0, 2), (0, 1)))[np.argmax(np.abs(normals), axis=1)]
    return np.take_along_axis((corners - squares.low) / squares.step, axes[:, None], axis=2)


def _cut(across: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Faces (m, 3, 2) cut along the sides of squares, which lie at whole numbers: the face of each triangle that they
    fall into, and the weights of its corners (3, 3, n), entry [i, k]: weight i of corner k."""
    parts, whole = ConvexPolygons.whole(len(across)), []
    while len(parts):
        breathe()
        corner = across.transpose(2, 1, 0)[:, :, parts.owner[parts.polygon]]
        place = (parts.weights * corner).sum(axis=1)
        low, high = (bound.reduceat(place, parts.start[:-1], axis=1) for bound in (np.minimum, np.maximum))
        first, last = np.floor(low + TOUCHING) + 1.0, np.ceil(high - TOUCHING) - 1.0
        axis = np.argmax(last - first, axis=0)
        every = np.arange(len(parts))
        cut = (last - first)[axis, every] >= 0.0
        breathe()
        whole.append(parts.select(~cut))
        chosen = np.flatnonzero(cut)
        parts, axis = parts.select(chosen), axis[chosen]
        side = np.floor(0.5 * (first + last))[axis, chosen]
        breathe()
        values = across[parts.owner, :, axis].T - side
        one = parts.cut(values, Line.HIDDEN)
        breathe()
        parts = ConvexPolygons.joined([one, parts.cut(-values, Line.HIDDEN)])
        breathe()
        parts = parts.select(parts.size >= 3)
    return ConvexPolygons.joined(whole).triangles(0.0)


def added(names: np.ndarray, flux: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each square once, with all its flux."""
    found = np.flatnonzero(np.bincount(names))
    breathe()
    return found, np.bincount(names, flux)[found]


def light_errors(light: tuple[np.ndarray, np.ndarray], thrown: list) -> dict:
    """Compare the light of a result in squares with that of several independent sets of traced rays.

    Parameters
    ----------
    light : tuple of (n,) int64 and (n,) float64
        Numbers of squares, and the flux in each, as `light_in_squares` returns them.
    thrown : list of such tuples
        One for each set of rays, at least two.

    Returns
    -------
    errors : dict
        `flux`; `flux_by_rays`, the mean over the sets; and `squares`, the number of squares that rays meet. In per cent
        of `flux_by_rays`: `flux_percent`, the difference of both, and `irradiance_percent`, the sum of absolute
        differences over the squares. `flux_noise_percent` is the standard error of `flux_by_rays`, and
        `irradiance_noise_percent` the value of `irradiance_percent` that noise of the rays alone makes expected.
        Percentages are None if rays meet no square.
    """
    every = np.unique(np.concatenate([names for names, _ in (light, *thrown)]))

    def laid(entry: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        whole = np.zeros(len(every))
        whole[np.searchsorted(every, entry[0])] = entry[1]
        return whole
    ours, rays = laid(light), np.array([laid(entry) for entry in thrown])
    mean, total = rays.mean(axis=0), float(rays.sum(axis=1).mean())
    known = {"flux": float(ours.sum()), "flux_by_rays": total, "squares": int((mean > 0.0).sum())}
    names = ("flux_percent", "flux_noise_percent", "irradiance_percent", "irradiance_noise_percent")
    if not total > 0.0:
        return known | dict.fromkeys(names)
    # standard errors of the means, and the mean amount of a normal deviation
    noise = rays.std(axis=0, ddof=1) / np.sqrt(len(rays)) * np.sqrt(2.0 / np.pi)
    whole = rays.sum(axis=1).std(ddof=1) / np.sqrt(len(rays))
    values = (ours.sum() - total, whole, np.abs(ours - mean).sum(), noise.sum())
    return known | {name: float(100.0 * value / total) for name, value in zip(names, values)}


def _runs(count: np.ndarray) -> list[slice]:
    """Runs of faces that lie on about `AT_ONCE` squares, `count` (m,) of them each."""
    share = (np.cumsum(count) - count) // AT_ONCE
    starts = np.flatnonzero(np.diff(share, prepend=-1))
    return [slice(int(start), int(stop)) for start, stop in zip(starts, np.append(starts[1:], len(count)))]
