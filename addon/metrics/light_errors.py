"""How far the light on surfaces is from that of rays: its flux, and its irradiance over small squares."""
from __future__ import annotations

import numpy as np

from ...core.support import breathe

BINS = 128  # squares along the longest side of the box round what is lit
BESIDE = 8  # squares round that box
FINE = 32.0  # places strewn over a face along a square's side
MOST_PLACES = 4096  # on one face
MOST_SQUARES = 4.0  # as large as that many faces may be, for these places to be enough; larger ones are quartered
PLACES_AT_ONCE = 1 << 21
GOLDEN = 0.6180339887498949


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
    """The squares that faces light, and the flux of each.

    Parameters
    ----------
    corners : (m, 3, 3) float64
    irradiance : (m, 3) float64
        At the corners, linear in between.
    normals : (m, 3) float64
        Of the surface that each face lies on.
    """
    corners, irradiance, normals = _quartered(corners, irradiance, normals, MOST_SQUARES * squares.step**2)
    area = _areas(corners)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    # as many as the longest side asks for: slivers are long
    count = np.ceil(FINE**2 * np.maximum(area, 0.05 * longest**2) / squares.step**2).astype(np.int64)
    count = np.clip(count, 8, MOST_PLACES) * (area > 0.0)
    found = []
    for part in _runs(count):
        breathe()
        face = np.repeat(np.arange(part.start, part.stop), count[part])
        first = np.cumsum(count[part]) - count[part]
        order = np.arange(len(face)) - np.repeat(first, count[part])
        own = count[face]
        u, v = (order + 0.5) / own, (order * GOLDEN + 0.5) % 1.0
        # a square folded over its diagonal
        over = u + v > 1.0
        u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
        weights = np.stack((1.0 - u - v, u, v), axis=1)
        light = (weights * irradiance[face]).sum(axis=1)
        total = np.bincount(face - part.start, light, minlength=part.stop - part.start)
        mean = (area * irradiance.mean(axis=1))[part]
        scale = mean / np.where(total > 0.0, total, 1.0)
        names = squares.names(np.einsum("nk,nkc->nc", weights, corners[face]), normals[face])
        found.append(added(names, light * scale[face - part.start]))
    return added(*(np.concatenate(one) for one in zip(*found)))


def added(names: np.ndarray, flux: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each square once, with all its flux."""
    found = np.flatnonzero(np.bincount(names))
    return found, np.bincount(names, flux)[found]


def light_errors(light: tuple[np.ndarray, np.ndarray], thrown: list) -> dict:
    """How far light in squares is from that of several throws of rays, each of them light in squares too.

    Returns
    -------
    errors : dict
        `flux` and `flux_by_rays`; in per cent of the latter `flux_percent`, how far they are apart, and
        `irradiance_percent`, the mean difference over the squares; and what the rays' own noise makes of both,
        `flux_noise_percent` and `irradiance_noise_percent`: for as many throws as these.
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


def _quartered(corners: np.ndarray, irradiance: np.ndarray, normals: np.ndarray,
               most: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Faces (m) in parts that are not larger than `most`, each with the irradiance at its corners and its normal."""
    done = []
    while len(corners):
        breathe()
        large = _areas(corners) > most
        done.append((corners[~large], irradiance[~large], normals[~large]))
        corners, irradiance = _quarters(corners[large]), _quarters(irradiance[large])
        normals = np.tile(normals[large], (4, 1))
    return tuple(np.concatenate(one) for one in zip(*done)) if done else (corners, irradiance, normals)


def _quarters(values: np.ndarray) -> np.ndarray:
    """Values (m, 3, ...) at the corners of faces, at those of their four parts (4 m, 3, ...)."""
    middle = 0.5 * (values + np.roll(values, -1, axis=1))
    (a, b, c), (ab, bc, ca) = np.moveaxis(values, 1, 0), np.moveaxis(middle, 1, 0)
    return np.concatenate([np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


def _areas(corners: np.ndarray) -> np.ndarray:
    a, b, c = np.moveaxis(corners, 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def _runs(count: np.ndarray) -> list[slice]:
    """Runs of faces that hold about `PLACES_AT_ONCE` places."""
    share = (np.cumsum(count) - count) // PLACES_AT_ONCE
    starts = np.flatnonzero(np.diff(share, prepend=-1))
    return [slice(int(start), int(stop)) for start, stop in zip(starts, np.append(starts[1:], len(count)))]
