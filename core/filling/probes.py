"""Probes: a few rays traced from the eye, to detect if whole regions of the mirror are missing from the result.

They check the method independently: they use the meshes and the law of reflection, but no three-ray cameras and no
result of the method's visibility tests.
"""
from __future__ import annotations

import numpy as np

from ..cameras import MirrorMap
from ..culling import SceneAndMirrors
from ..geometry import TriangleMesh, dot, following, largest, ranges, shares, smallest, unit
from ..support import breathe
from ..trees import SceneTree, first_crossed
from ..views import LampView, View

ACROSS = 16  # probes along each side of the mirror's box in the picture
MARGIN = 1.0  # pixels: a face also covers probes this close to it
PAIRS_AT_ONCE = 1 << 18  # pairs of a face and a probe per chunk
SAME_PLACE = 1e-6  # relative tolerance for equal distances from the eye


def missed_probes(view: View, mirror: TriangleMesh, mirror_map: MirrorMap, met: SceneAndMirrors,
                  mirror_position: np.ndarray, triangles: np.ndarray) -> tuple[int, int]:
    """Count the probes that see a diffuse object in the mirror, and those of them that no face covers.

    Parameters
    ----------
    mirror_position : (n, 3) float64, places of the vertices on the mirror
    triangles : (m, 3) int64, the faces
    """
    low, step = _lattice(view, mirror)
    y, x = np.divmod(np.arange(ACROSS * ACROSS), ACROSS)
    origin, ray = (given.T for given in view.rays(low + step * (np.stack((x, y), axis=1) + 0.5)))
    alone = np.array_equal(mirror.positions, met.mirrors.positions) and np.array_equal(mirror.triangles,
                                                                                       met.mirrors.triangles)
    face, distance = first_crossed(met.mirror_tree if alone else SceneTree.of_ordered(mirror), origin, ray)
    asked = np.flatnonzero(face >= 0)
    # keep probes that see the mirror first: no object or other mirror is in front
    nearest = met.first_distances(origin[:, asked], ray[:, asked], alone)
    seen = asked[distance[asked] <= (1.0 + SAME_PLACE) * nearest]
    place = origin[:, seen] + distance[seen] * ray[:, seen]
    face = face[seen]
    leaving = mirror_map.rays(face, mirror_map.coordinates(face, place))
    flat = mirror_map.surface.face_normal[:, face]
    shown, _ = met.first_met((place, flat * np.sign(dot(leaving, flat))), place, unit(leaving))
    wanted = (shown >= 0) & (shown < met.diffuse)
    if isinstance(view, LampView):
        # a lamp's probes count only where its light reaches the mirror
        wanted &= view.lights(np.repeat(place[:, None], 3, axis=1))
    expected = seen[wanted]
    covered = _covered(view.pixels(mirror_position)[triangles], low, step)
    return len(expected), int((~covered[expected]).sum())


def _lattice(view: View, mirror: TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the low corner (2,) of the mirror's box in the picture, and the distance (2,) of probes, in pixels."""
    used = mirror.positions[mirror.used]
    resolution = np.array(view.resolution, dtype=np.float64)
    low, high = np.zeros(2), resolution
    if (view.depths(used) > 0.0).all():
        pixels = np.clip(view.pixels(used), 0.0, resolution)
        low, high = pixels.min(axis=0), pixels.max(axis=0)
    return low, np.maximum(high - low, 1e-9) / ACROSS


def _covered(corners: np.ndarray, low: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return True for probes that some face with `corners` (m, 3, 2), in pixels, covers; as an array of all probes."""
    places = (corners - low) / step - 0.5
    breathe()
    first = _numbers(np.ceil(smallest(places.swapaxes(0, 1)) - MARGIN / step))
    breathe()
    last = _numbers(np.floor(largest(places.swapaxes(0, 1)) + MARGIN / step))
    breathe()
    first, count = np.maximum(first, 0), np.minimum(last, ACROSS - 1) + 1 - np.maximum(first, 0)
    face, covered = np.flatnonzero((count > 0).all(axis=1)), np.zeros(ACROSS * ACROSS, dtype=bool)
    for part in shares(count[face].prod(axis=1), PAIRS_AT_ONCE):
        some = face[part]
        y, row = ranges(first[some, 1], count[some, 1])
        x, run = ranges(first[some[row], 0], count[some[row], 0])
        some, y = some[row[run]], y[run]
        offset = corners[some] - (low + step * (np.stack((x, y), axis=1) + 0.5))[:, None]
        after = following(offset)
        across = offset[..., 0] * after[..., 1] - offset[..., 1] * after[..., 0]
        away = across / np.maximum(np.linalg.norm(after - offset, axis=2), 1e-300)
        away *= np.sign(across.sum(axis=1))[:, None]
        covered[(y * ACROSS + x)[away.min(axis=1) >= -MARGIN]] = True
        if covered.all():
            break
    return covered


def _numbers(bound: np.ndarray) -> np.ndarray:
    """Convert bounds (m, 2) to columns and rows of probes, clamped to the range from -1 to `ACROSS`."""
    return np.clip(np.nan_to_num(bound), -1, ACROSS).astype(np.int64)
