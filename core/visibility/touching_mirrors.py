"""Mirror triangles that touch a camera's own in a corner or a side, and whether the camera sees more of them."""
from __future__ import annotations

import numpy as np

from ..culling import ABOVE, Candidates, SceneAndMirrors
from ..geometry import norm
from ..polygons import clip
from ..support import portions

BEHIND = 0.02  # share of a triangle's size: hits as near to a ray that starts behind the triangle do not count
PROBED_AT_ONCE = 16384  # pairs of a camera and a triangle of a mirror

_PROBES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]).T / 4.0


def plainly_seen(met: SceneAndMirrors, candidates: Candidates) -> np.ndarray:
    """Return True for candidates (p,), all of them mirror triangles, that the camera sees more of than a shared edge.

    A neighbour that shares a corner or a side with the camera's own triangle counts only if one of the camera's
    `_PROBES` meets it, or the ray in the centre of the region that it covers. That is so across a groove.
    """
    kept = np.ones(len(candidates), dtype=bool)
    for portion in portions(len(candidates), PROBED_AT_ONCE):
        part = portion.start + _touching(met, candidates.select(portion))
        asked = candidates.select(part)
        kept[part] = _probed(met, asked, np.repeat(_PROBES[:, :, None], len(part), axis=2))
        doubtful = np.flatnonzero(~kept[part])
        asked = asked.select(doubtful)
        covered = clip(asked)
        kept[part[doubtful[covered.pair]]] = _probed(met, asked.select(covered.pair), covered.middles[:, None])
    return kept


def _touching(met: SceneAndMirrors, candidates: Candidates) -> np.ndarray:
    """Return the indices (k,) of candidates whose triangle shares a corner with the camera's own mirror triangle.

    The triangles of all `candidates` must be mirror triangles; this is not checked. The camera's own triangle is the
    one that its rays leave, on the last mirror. A corner is shared if all coordinates agree to within the share `ABOVE`
    of the mirrors' size, `met.size`.
    """
    cameras, frames = candidates.cameras, candidates.frames
    surface, face = cameras.mirror_map.last(cameras.face[candidates.camera])
    own = surface.corners(face)
    other = np.take(met.mirror_corners, frames.triangle[candidates.column] - met.diffuse, axis=1)
    apart = np.abs(own[:, :, None] - np.swapaxes(other, 1, 2)[:, None]).max(axis=0)
    return np.flatnonzero((apart <= ABOVE * met.size).any(axis=(0, 1)))


def _probed(met: SceneAndMirrors, candidates: Candidates, probes: np.ndarray) -> np.ndarray:
    """Return True for candidates (p,), all of them mirror triangles, that one of k rays of their cameras meets.

    `probes` (3, k, p) are the rays' weights in the cameras.
    """
    cameras, frames = candidates.cameras, candidates.frames
    corners, count = cameras.corners[candidates.camera].T, probes.shape[1]
    origins, rays = (np.einsum("xkn,kpn->xpn", np.take(values, corners, axis=1), probes).reshape(3, -1)
                     for values in (cameras.origins, cameras.rays))
    probed = np.tile(candidates.column, count)
    s = frames.distance(probed, origins, rays)
    near = np.full(len(probed), ABOVE * met.size)
    if cameras.mirror_map.bounce > 1:
        # later cameras follow the sides of their triangles only nearly, and may begin a little behind the next
        corners = np.take(met.mirror_corners, frames.triangle[candidates.column] - met.diffuse, axis=1)
        behind = np.tile(_side(candidates), count) * frames.height(probed, origins) <= 0.0
        near[behind] = BEHIND * np.tile(np.ptp(corners, axis=2).max(axis=0), count)[behind]
    ahead = s * norm(rays) > near
    seen = ahead & (frames.weights(probed, origins + s * rays) > ABOVE).all(axis=0)
    return seen.reshape(count, -1).any(axis=0)


def _side(candidates: Candidates) -> np.ndarray:
    """Return the side (p,) of the candidates' planes on which the cameras' own triangles lie: 1 or -1, 0 for both."""
    cameras, frames = candidates.cameras, candidates.frames
    surface, face = cameras.mirror_map.last(cameras.face[candidates.camera])
    corners = np.moveaxis(surface.corners(face), 1, 0)
    heights = np.stack([frames.height(candidates.column, corner) for corner in corners])
    room = ABOVE * np.abs(heights).max(axis=0)
    return (heights.min(axis=0) >= -room) * 1.0 - (heights.max(axis=0) <= room)
