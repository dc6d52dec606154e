"""The flux of a face, and irradiance at its corners that amounts to it."""
from __future__ import annotations

import numpy as np

from ..geometry import View

MOST = 2.0  # of a face's mean: how much more a corner may have, near a caustic, where the map tells infinity
BELIEVED = 0.5  # of the larger of a face's area and that of what its light falls on: the smaller

SINGLE = 2.0**-23  # of what is lit: by how much single precision may move its corners


def flux_of(view: View, places: np.ndarray) -> np.ndarray:
    """The part of the lamp's picture that triangles with corners (m, 3, 3) cover: their solid angle, or for parallel
    light their area across it.

    A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 1983.
    """
    if view.orthographic:
        area = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        return 0.5 * np.abs(area @ view.forward)
    ways = places - view.eye
    ways = ways / np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), 1e-300)
    a, b, c = np.moveaxis(ways, 1, 0)
    # differences of neighbours keep the digits of small triangles
    triple = np.abs(np.einsum("ij,ij->i", a, np.cross(b - a, c - a)))
    return 2.0 * np.arctan2(triple, 1.0 + (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1))


def shown_area(corners: np.ndarray, area: np.ndarray) -> np.ndarray:
    """What the `area` (m,) of faces with `corners` (m, 3, 3) may be where they are drawn, in single precision: that of
    slivers is rounding."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    return area + SINGLE * np.ptp(corners.reshape(-1, 3), axis=0).max() * longest if len(area) else area


def on_faces(flux: np.ndarray, area: np.ndarray, bulge: np.ndarray) -> np.ndarray:
    """The part of the `flux` (m,) that falls on the `area` (m,) of faces alone, without what bulges out of their sides
    and with what is dented: all of it where so much bulges that a parabola does not tell how much it is."""
    whole = area + bulge
    share = flux * np.where((whole > BELIEVED * area) & (BELIEVED * whole < area), area / np.where(
        whole > 0.0, whole, 1.0), 1.0)
    return share * (flux.sum() / max(share.sum(), 1e-300))


def balanced(irradiance: np.ndarray, flux: np.ndarray, area: np.ndarray, triangles: np.ndarray,
             shown: np.ndarray) -> np.ndarray:
    """Irradiance (m, 3) at the corners of faces, infinite on caustics, as finite values that amount to the `flux` (m,)
    over the `area` (m,).

    What the values of a face still lack of its flux over the area that is `shown` (m,), or have too much, is shared out
    between the faces round its corners: slivers, whose area is rounding, do not keep it to themselves.
    """
    corner = triangles.ravel()
    count = int(corner.max(initial=-1)) + 1

    def round_vertices(values: np.ndarray) -> np.ndarray:
        return np.bincount(corner, np.repeat(values, 3), minlength=count)

    covered = np.where(shown > 0.0, shown, 1.0)
    bounded = np.minimum(irradiance, (MOST * flux / covered)[:, None])
    scale = np.clip(flux / np.maximum(shown * bounded.mean(axis=1), 1e-300), 1.0 / MOST, MOST)
    bounded *= scale[:, None]
    round_area = round_vertices(shown)
    missing = round_vertices(flux - shown * bounded.mean(axis=1)) / np.where(round_area > 0.0, round_area, 1.0)
    found = np.maximum(bounded + missing[triangles], 0.0)
    return found * (flux.sum() / max((area * found.mean(axis=1)).sum(), 1e-300))
