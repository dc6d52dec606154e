"""Merging of border vertices of one surface that lie at the same place of the picture."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import connected, doubled_areas, following, groups, in_order, ranges
from ..result import ReflectionMesh
from ..support import breathe
from .borders import Borders
from .surfaces import Surfaces

SAME = 0.004  # pixels: vertices no farther apart count as being at the same place
SHIFTS = SAME * np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)])
MOST = 32  # largest number of comparisons per vertex: at the tip of a fan, more vertices may lie at one place


def with_places_joined(mesh: ReflectionMesh, surfaces: Surfaces) -> ReflectionMesh:
    """Return the result with border vertices merged if they lie at one place and show the same surface."""
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
    # merging may flip slivers: flip them back
    pixels = surfaces.pixels
    turned = doubled_areas(pixels[joined.triangles]) * doubled_areas(pixels[mesh.triangles[kept]]) < 0.0
    for part in (joined.triangles, joined.source_weights):
        part[turned] = part[turned][:, [0, 2, 1]]
    return joined


def _in_one_place(spots: np.ndarray) -> np.ndarray:
    """Return pairs (2, k) of `spots` (n, 2), in pixels, in the same cell of a grid with cells of `SAME` pixels."""
    cell = np.floor(spots / SAME).astype(np.int64)
    _, place = groups(*(cell - cell.min(axis=0, initial=0)).T)
    order = in_order(place)
    count = np.bincount(place)
    # pair each spot with the later ones in its cell
    rank = np.arange(len(spots))
    behind = np.minimum(np.cumsum(count)[place[order]] - rank - 1, MOST)
    other, run = ranges(rank + 1, behind)
    breathe()
    return np.stack((order[run], order[other]))
