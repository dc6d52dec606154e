"""One vertex for those of the borders of one surface that lie in one place."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import connected, doubled_areas, following, groups, in_order, ranges
from ..result import ReflectionMesh
from ..support import breathe
from .borders import Borders
from .surfaces import Surfaces

SAME = 0.004  # pixels: vertices that are no farther apart are in one place
SHIFTS = SAME * np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)])
MOST = 32  # of the vertices in one place: where more lie, as at the tip of a fan, not each is compared with each


def with_places_joined(mesh: ReflectionMesh, surfaces: Surfaces) -> ReflectionMesh:
    """The result with one vertex for those that lie in one place."""
    vertex, face = Borders.of(mesh.triangles, surfaces.pixels).ends()
    pairs = [_in_one_place(surfaces.pixels[vertex] + shift) for shift in SHIFTS]
    one, other = np.concatenate(pairs, axis=1)
    new = np.flatnonzero(vertex[one] != vertex[other])
    once, _ = groups(one[new], other[new])
    one, other = one[new[once]], other[new[once]]
    goes_on = surfaces.goes_on(mesh, (face[one], face[other]), (vertex[one], vertex[other], vertex[other]))
    one, other = vertex[one[goes_on]], vertex[other[goes_on]]
    if not len(one):
        return mesh
    ends, stands = np.stack((one, other), axis=1), np.arange(len(mesh.positions))
    place = np.repeat(connected(ends), 2)
    lowest = np.full(int(place.max()) + 1, len(stands))
    np.minimum.at(lowest, place, ends.ravel())
    stands[ends.ravel()] = lowest[place]
    triangles = stands[mesh.triangles]
    kept = np.flatnonzero((triangles != following(triangles)).all(axis=1))
    joined = replace(mesh, triangles=triangles[kept], **mesh.of_faces(kept))
    # slivers may be turned over by that, and are turned back
    pixels = surfaces.pixels
    turned = doubled_areas(pixels[joined.triangles]) * doubled_areas(pixels[mesh.triangles[kept]]) < 0.0
    for part in (joined.triangles, joined.source_weights):
        part[turned] = part[turned][:, [0, 2, 1]]
    return joined


def _in_one_place(spots: np.ndarray) -> np.ndarray:
    """Pairs (2, k) of spots (n, 2) in the same cell of a grid that is as fine as places are told apart."""
    cell = np.floor(spots / SAME).astype(np.int64)
    _, place = groups(*(cell - cell.min(axis=0, initial=0)).T)
    order = in_order(place)
    count = np.bincount(place)
    # each with those behind it in its place
    rank = np.arange(len(spots))
    behind = np.minimum(np.cumsum(count)[place[order]] - rank - 1, MOST)
    other, run = ranges(rank + 1, behind)
    breathe()
    return np.stack((order[run], order[other]))
