"""The flux of a face, and irradiance at its corners that amounts to it."""
from __future__ import annotations

import numpy as np

from ..geometry import edge_lengths, in_order, shared_edges, solid_angles
from ..views import View

MOST = 2.0  # largest irradiance at a corner, in multiples of the face's mean: on a caustic the map's value is infinite
LOST = 0.9  # largest share of its flux that a face gives to its neighbours because its sides are straight

SINGLE = 2.0**-23  # rounding of corners in single precision, as share of the lit region's size


def flux_of(view: View, places: np.ndarray) -> np.ndarray:
    """Return the flux (m,) from a lamp of unit intensity to triangles with corners `places` (m, 3, 3) in world space.

    This is their solid angle, or for parallel light their area perpendicular to it.
    """
    if view.orthographic:
        area = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        return 0.5 * np.abs(area @ view.forward)
    return np.abs(solid_angles(view.eye, places))


def shown_area(corners: np.ndarray, area: np.ndarray, reach: float) -> np.ndarray:
    """Return the `area` (m,) of faces plus the area error of drawing them in single precision.

    For slivers the error dominates. `corners` (m, 3, 3) are the faces' corners; `reach` is the size of the lit region.
    """
    return np.hypot(area, SINGLE * reach * edge_lengths(corners).max(axis=1, initial=0.0))


def on_faces(flux: np.ndarray, beside: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Correct the `flux` (m,) of faces for their straight sides, and return the flux (m,) that falls on each face.

    Light between a straight side and the true curve goes to the face across the side. It stays if there is no such
    face, or more than one. A face gives away at most the share `LOST` of its flux.

    Parameters
    ----------
    flux : (m,) float64, flux within the true curves around each face
    beside : (m, 3) float64
        Flux between the straight sides 01, 12, 20 and the true curves; negative if the curve lies inside of the face.
        NaN counts as zero. A side of two faces has two independent estimates, with opposite signs: half of their
        difference is moved. Each is limited to the flux of the face that gives it away.
    triangles : (m, 3) int64, vertices of the faces
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
    """Return finite irradiance (m, 3) at the corners of faces, scaled so that it integrates to the `flux`.

    The remaining difference of a face to its flux is distributed over the faces around its corners. So slivers, whose
    area is rounding, do not get it alone.

    Parameters
    ----------
    irradiance : (m, 3) float64, may be infinite on caustics
    flux : (m,) float64
    triangles : (m, 3) int64, vertices of the faces
    shown : (m,) float64, area of the faces, from `shown_area`
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
    """Scale the irradiance (m, 3) of faces with an `area` (m,) so that its integral is the sum of the `flux` (m,).

    Before, slivers may have had too little area for their flux.
    """
    return irradiance * (flux.sum() / max((area * irradiance.mean(axis=1)).sum(), 1e-300))
