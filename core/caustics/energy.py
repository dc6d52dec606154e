"""The flux of a face, and irradiance at its corners that amounts to it."""
from __future__ import annotations

import numpy as np

from ..geometry import edge_lengths, in_order, shared_edges, solid_angles
from ..views import View

MOST = 2.0  # of a face's mean: how much more a corner may have, near a caustic, where the map tells infinity
LOST = 0.9  # of its flux: the most that falls beside a face with straight sides

SINGLE = 2.0**-23  # of what is lit: by how much single precision may move its corners


def flux_of(view: View, places: np.ndarray) -> np.ndarray:
    """The part of the lamp's picture that triangles with corners (m, 3, 3) cover: their solid angle, or for parallel
    light their area across it."""
    if view.orthographic:
        area = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        return 0.5 * np.abs(area @ view.forward)
    return np.abs(solid_angles(view.eye, places))


def shown_area(corners: np.ndarray, area: np.ndarray, reach: float) -> np.ndarray:
    """What the `area` (m,) of faces with `corners` (m, 3, 3) may be where they are drawn, in single precision with all
    that is lit, which reaches so far: that of slivers is rounding."""
    return np.hypot(area, SINGLE * reach * edge_lengths(corners).max(axis=1, initial=0.0))


def on_faces(flux: np.ndarray, beside: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The part of the `flux` (m,) that falls on faces (m, 3) with straight sides.

    Parameters
    ----------
    beside : (m, 3) float64
        Light that falls beyond the sides 01, 12, 20, or, where it is negative, is missing before them. It falls on
        the face across, if there is one, and on the face itself if not: what one loses another gains.
    """
    _, _, edge = shared_edges(triangles)
    sides = in_order(edge.ravel())
    number = edge.ravel()[sides]
    first = np.flatnonzero(np.bincount(number)[number] == 2)[::2]
    one, other = sides[first], sides[first + 1]
    lost = np.where(np.isnan(beside), 0.0, beside).ravel()
    over = 0.5 * (np.clip(lost[one], -flux[other // 3], flux[one // 3])
                  - np.clip(lost[other], -flux[one // 3], flux[other // 3]))
    loser = np.where(over > 0.0, one, other) // 3
    share = np.minimum(1.0, LOST * flux / np.maximum(np.bincount(loser, np.abs(over), minlength=len(flux)), 1e-300))
    over *= share[loser]
    return flux - np.bincount(one // 3, over, minlength=len(flux)) + np.bincount(other // 3, over, minlength=len(flux))


def balanced(irradiance: np.ndarray, flux: np.ndarray, triangles: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """Irradiance (m, 3) at the corners of faces, infinite on caustics, as finite values that amount to the `flux` (m,)
    over the area that is `shown` (m,).

    What the values of a face still lack of its flux, or have too much, is shared out between the faces round its
    corners: slivers, whose area is rounding, do not keep it to themselves.
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
    return np.maximum(bounded + missing[triangles], 0.0)


def amounting(irradiance: np.ndarray, flux: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Irradiance (m, 3) that amounts to all of the `flux` (m,): slivers may have lacked the area for theirs."""
    return irradiance * (flux.sum() / max((area * irradiance.mean(axis=1)).sum(), 1e-300))
