"""Light that mirrors throw, by rays one by one from places strewn over the mirror: what meshes of light are judged by.

A place on the mirror that stands for the area A, at the distance d from a lamp of 1 W/sr and met at the angle t, brings
A cos(t) / d^2 W along; for a sun of 1 W/m2 it is A cos(t). Where smooth normals send it on at another angle to the flat
triangle than it came, it is weighted by the sines of both, as light must be that a path tracer shall find as bright
(E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.3): none of what would enter the
triangle and is lifted out of it. A ray back to the lamp tells whether the light comes there, one along the reflection
where it goes. Places are strewn evenly, by a lattice in each triangle that is shifted at random: several throws are
independent of each other, and their differences tell their noise.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...cameras import MirrorSurface
from ...caustics import Lamp
from ...geometry import TriangleMesh, dot, norm
from ...support import breathe
from ...trees import BoxTree, first_hits

SMALLEST = 1e-12  # sine of a way to a triangle: one that runs along it is sent on as if it did not quite
TOUCHING = 1e-9  # share of a path's length: a hit as near before its end is the end
GOLDEN = 0.6180339887498949
# largest size of a part of the mirror, relative to its distance from the lamp; how often triangles may be split for it
NEAR, LEVELS = 0.5, 12
Tracer = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""(origins (3, n), directions (3, n), triangles that they start on (n,), -1 for none) -> the first triangle (n,), -1
where none, and its distance in lengths of the direction."""


@dataclass(frozen=True)
class Landed:
    """Light (n) where it fell.

    Attributes
    ----------
    points : (n, 3) float64
    flux : (n,) float64
        For a lamp of 1 W/sr, or a sun of 1 W/m2.
    source_face : (n,) int64
        Triangle of the receivers.
    start : (n, 3) float64
        Where on the first mirror.
    met : list of (n,) int64
        The mirror's triangle for each bounce, -1 from the one on that did not take place.
    cosine : list of (n,) float64
        Of the angle at which each mirror was met; negative at the back of its triangle.
    bent : (n,) bool
        Whether smooth normals would have sent it into a mirror's flat triangles, so that it was lifted out of them.
    """

    points: np.ndarray
    flux: np.ndarray
    source_face: np.ndarray
    start: np.ndarray
    met: list
    cosine: list
    bent: np.ndarray


class LightRays:
    """Rays between mirrors and receivers, with what else stands in the way.

    Parameters
    ----------
    mirror, receivers : TriangleMesh
    mirrors, blockers : TriangleMesh, optional
        As in `core.caustics`.
    tracer : function of the joined mesh that gives a `Tracer`, optional
        Where another one than NumPy's is at hand.
    """

    def __init__(self, mirror: TriangleMesh, receivers: TriangleMesh, mirrors: TriangleMesh | None = None,
                 blockers: TriangleMesh | None = None,
                 tracer: Callable[[TriangleMesh], Tracer] | None = None) -> None:
        parts = [mesh for mesh in (mirror, mirrors, receivers, blockers) if mesh is not None]
        self._mirror, self._receivers = mirror, receivers
        self._body = TriangleMesh.joined([mesh for mesh in (mirror, mirrors) if mesh is not None])
        self._whole = TriangleMesh.joined(parts)
        self._surface = MirrorSurface(self._body)
        self._trace = (tracer or by_boxes)(self._whole)

    def thrown(self, lamp: Lamp, count: int, seed: int = 0, depth: int = 1) -> Landed:
        """Trace about `count` light rays from the `lamp`, reflected all over the mirror up to `depth` times."""
        face, uv, area = _strewn(self._mirror, lamp, count, np.random.default_rng(seed))
        breathe()
        place = self._surface.places(face, uv)
        breathe()
        way = lamp.directions(place.T).T.copy()
        length = norm(way)
        flux = area * self._sine(face, way) / (1.0 if lamp.sun else length**2)
        breathe()
        lit = self._lit(lamp, place, way, face) & (flux > 0.0)
        face, uv, flux, way, start = face[lit], uv[:, lit], flux[lit], way[:, lit], place[:, lit]
        found, met, cosine = [], [], []
        origin, number, bent = start, np.arange(len(face)), np.zeros(len(face), dtype=bool)
        first_receiver = len(self._body.triangles)
        last_receiver = first_receiver + len(self._receivers.triangles)
        for _ in range(depth):
            breathe()
            way, upright, weight, lifted = self._reflected(face, uv, way)
            flux[number] *= weight
            bent[number] |= lifted
            met.append(np.full(start.shape[1], -1))
            cosine.append(np.ones(start.shape[1]))
            met[-1][number], cosine[-1][number] = face, upright
            hit, distance = self._trace(origin, way, face)
            breathe()
            end = origin + np.where(np.isfinite(distance), distance, 0.0) * way
            own = (hit >= first_receiver) & (hit < last_receiver)
            found.append((number[own], end[:, own], hit[own] - first_receiver))
            on = (hit >= 0) & (hit < first_receiver)
            number, face, way, origin = number[on], hit[on], way[:, on], end[:, on]
            breathe()
            uv = self._surface.coordinates(face, origin)
        breathe()
        which, points, source = (np.concatenate(one, axis=-1) for one in zip(*found))
        return Landed(points.T, flux[which], source, start[:, which].T, [one[which] for one in met],
                      [one[which] for one in cosine], bent[which])

    def _lit(self, lamp: Lamp, place: np.ndarray, way: np.ndarray, face: np.ndarray) -> np.ndarray:
        """Return True (n,) if nothing stands between the lamp and each `place` (3, n), on mirror triangle `face` (n,).

        `way` (3, n) leads from the lamp to the place.
        """
        _, distance = self._trace(place, -way, face)
        return distance == np.inf if lamp.sun else distance >= 1.0 - TOUCHING

    def _sine(self, face: np.ndarray, way: np.ndarray) -> np.ndarray:
        """Return the sine (n,) of the angle between each `way` (3, n) and the plane of its triangle `face` (n,)."""
        return np.abs(dot(way, self._surface.face_normal[:, face])) / np.maximum(norm(way), 1e-300)

    def _reflected(self, face: np.ndarray, uv: np.ndarray,
                   way: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Reflect rays with directions `way` (3, n) at the mirror.

        Returns
        -------
        ray : (3, n) float64, unit directions
        cosine : (n,) float64, of the angle of incidence
        weight : (n,) float64, share of their light that a path tracer finds
        lifted : (n,) bool, True for rays that would enter the surface and were lifted above it
        """
        way = way / np.maximum(norm(way), 1e-300)
        ray = self._surface.unbent(face, uv, way)
        breathe()
        rise, lifted = self._surface.rise(face, ray, way), self._surface.enters(face, ray, way)
        breathe()
        self._surface.lift(face, uv, ray, way)
        weight = np.maximum(rise, 0.0) / np.maximum(self._sine(face, way), SMALLEST)
        # the ray's direction changes by twice its angle to the mirror's plane
        side = np.where(dot(way, self._surface.face_normal[:, face]) > 0.0, -1.0, 1.0)
        return ray, side * np.sqrt(np.clip(0.5 * (1.0 - dot(way, ray)), 0.0, 1.0)), weight, lifted


def by_boxes(mesh: TriangleMesh) -> Tracer:
    """Make a tracer of rays with NumPy, by a tree of boxes over `mesh`."""
    tree = BoxTree.build(mesh)

    def trace(origins: np.ndarray, directions: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        hits = first_hits(tree, origins, directions, asked=lambda ray, triangle: triangle != own[ray])
        return hits.triangle, hits.distance
    return trace


def _strewn(mirror: TriangleMesh, lamp: Lamp, count: int,
            rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sample about `count` places on the mirror, more where more light arrives, some everywhere.

    Returns
    -------
    face : (n,) int64, triangle of the mirror
    uv : (2, n) float64, coordinates in it
    area : (n,) float64, area of the mirror that each place represents
    """
    owner, own = _parts(mirror, lamp)
    a, b, c = _corners(mirror, owner, own)
    normal = 0.5 * np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    way = lamp.directions((a + b + c) / 3.0)
    # a triangle near the lamp counts as one as far away as it is large
    squared = 1.0 if lamp.sun else np.maximum((way**2).sum(axis=1), area)
    upright = np.abs((normal * way).sum(axis=1)) / np.maximum(np.linalg.norm(way, axis=1), 1e-300)
    share = (0.9 * upright + 0.1 * area) / squared
    number = np.maximum(np.rint(count * share / max(share.sum(), 1e-300)), 1).astype(np.int64) * (area > 0.0)
    part = np.repeat(np.arange(len(area)), number)
    breathe()
    order = np.arange(len(part)) - np.repeat(np.cumsum(number) - number, number)
    shift = rng.random((2, len(area)))[:, part]
    breathe()
    u, v = (order / number[part] + shift[0]) % 1.0, (order * GOLDEN + shift[1]) % 1.0
    breathe()
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    breathe()
    corner = own[part].transpose(1, 2, 0)
    uv = corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0])
    return owner[part], uv, (area / np.maximum(number, 1))[part]


def _parts(mirror: TriangleMesh, lamp: Lamp) -> tuple[np.ndarray, np.ndarray]:
    """Split the mirror's triangles into parts that are smaller than `NEAR` times their distance from the lamp.

    Returns
    -------
    owner : (p,) int64, triangle of each part
    own : (p, 3, 2) float64, its corners in the triangle, as (u, v)
    """
    count = len(mirror.triangles)
    owner = np.arange(count)
    own = np.broadcast_to(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), (count, 3, 2))
    for _ in range(0 if lamp.sun else LEVELS):
        corners = np.stack(_corners(mirror, owner, own))
        size = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=2).max(axis=0)
        distance = np.linalg.norm(lamp.directions(corners.mean(axis=0)), axis=1)
        large = size > NEAR * distance
        if not large.any():
            break
        middle = 0.5 * (own[large] + np.roll(own[large], -1, axis=1))
        a, b, c = own[large].swapaxes(0, 1)
        ab, bc, ca = middle.swapaxes(0, 1)
        quarters = [np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        owner = np.concatenate((owner[~large], np.tile(owner[large], 4)))
        own = np.concatenate((own[~large], *quarters))
    return owner, own


def _corners(mirror: TriangleMesh, owner: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the world positions, three (p, 3), of the parts' corners `own` (p, 3, 2) in triangles `owner` (p,)."""
    a, b, c = np.moveaxis(mirror.positions[mirror.triangles[owner]], 1, 0)
    first, second, third = (a + own[:, k, :1] * (b - a) + own[:, k, 1:] * (c - a) for k in range(3))
    return first, second, third
