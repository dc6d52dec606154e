"""What rays that leave a mirror may meet: the diffuse scene, and the mirrors themselves where they can be seen in it.

A mirror hides what lies behind it in its own reflection, as it does in that of others, and where a second bounce is
asked for it is the next mirror. Convex mirrors never see themselves: their triangles all lie below each other's planes.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .bounded_trace import bounded_trace
from .cameras import Cameras
from .candidates import Candidates
from .clipping import clip
from .cones import Cones
from .mirror_surface import MirrorSurface
from .point_tree import PointTree
from .reflection_map import ReflectionMap
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .stepping import breathe
from .triangle_mesh import TriangleMesh
from .subdivision import shared_edges
from .vectors import cross, dot, norm, ranges, rows, shares, unit

IMAGES_AT_ONCE = 500_000  # pairs of an image and a triangle of a mirror that may hide it
MOST_PAIRS = 1 << 22  # of cameras and triangles of mirrors that are asked which images they hide
ABOVE = 1e-9  # of the mirrors' size, or of a triangle's: what rises less above a plane touches it by rounding
BEHIND = 0.02  # of a triangle's size
PROBED_AT_ONCE = 16384  # pairs of a camera and a triangle of a mirror

_PROBES = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]).T / 4.0


class MetSurfaces:
    """Triangles that may be met: those of the diffuse scene, and behind them those of the mirrors.

    Attributes
    ----------
    tree : SceneTree or PointTree
        Of the diffuse scene.
    positions : (n, 3) float64
    triangles : (m, 3) int64
    diffuse : int
        How many triangles are diffuse; the others are the mirrors'.
    surface : MirrorSurface
        Of the mirrors.
    size : float
        Of the mirrors: the longest side of the box round them, in scene units.
    """

    def __init__(self, tree: SceneTree | PointTree, mirrors: TriangleMesh) -> None:
        self.tree, self._mirror_tree = tree, SceneTree.of_ordered(mirrors)
        self._mirror_corners = rows(mirrors.positions[mirrors.triangles])
        self.size = float(np.ptp(mirrors.positions[mirrors.triangles.ravel()], axis=0).max())
        self.diffuse = len(tree.mesh.triangles)
        self.surface = MirrorSurface(mirrors)
        self._beyond = rows(_opposite(mirrors))
        self.positions = np.concatenate((tree.mesh.positions, mirrors.positions))
        self.triangles = np.concatenate((tree.mesh.triangles, mirrors.triangles + len(tree.mesh.positions)))

    @property
    def bounds(self) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius of a sphere round the diffuse scene."""
        sphere = self.tree.spheres[0][:, 0]
        return sphere[:3], float(sphere[3])

    def showing_mirrors(self, mirror_map: ReflectionMap, cameras: Cameras, most: int) -> np.ndarray:
        """Which faces of the map, by their number, may show a mirror in any of the cameras, those among them for which
        more than `most` pairs of cameras and triangles would have to be looked at."""
        camera, _, _, given_up = self._mirrors_in(mirror_map, cameras, most, np.ones(len(cameras)))
        found = np.zeros(int(cameras.face.max(initial=-1)) + 1, dtype=bool)
        found[cameras.face[camera]] = True
        found[cameras.face[given_up]] = True
        return found

    def showing_scene(self, cameras: Cameras) -> np.ndarray:
        """Which cameras (n,) may show the diffuse scene."""
        centre, radius = self.bounds
        count = len(cameras)
        return Cones.around(cameras).touch(np.arange(count), np.repeat(centre[:, None], count, axis=1),
                                           np.full(count, radius))

    def trace(self, mirror_map: ReflectionMap, cameras: Cameras, showing: np.ndarray, most: int,
              worth: np.ndarray) -> tuple[np.ndarray, np.ndarray, int, np.ndarray]:
        """Pairs of cameras and triangles that may be seen in them, how many tree nodes were visited for that, and which
        cameras (n,) were given up, by their `worth` (n,), since there would be more than `most` pairs; mirrors are
        looked for on the faces that `showing_mirrors` found."""
        camera, triangle, visited, given_up = bounded_trace(self.tree, Cones.around(cameras), most, worth)
        chosen = np.flatnonzero(showing[cameras.face])
        mirror_camera, mirror_triangle, more, mirror_given_up = self._mirrors_in(mirror_map, cameras.select(chosen),
                                                                                 most, worth[chosen])
        given_up[chosen[mirror_given_up]] = True
        camera = np.concatenate((camera, chosen[mirror_camera]))
        triangle = np.concatenate((triangle, mirror_triangle + self.diffuse))
        if given_up.any():
            kept = ~given_up[camera]
            camera, triangle = camera[kept], triangle[kept]
        return camera, triangle, visited + more, given_up

    def _mirrors_in(self, mirror_map: ReflectionMap, cameras: Cameras, most: int,
                    worth: np.ndarray) -> tuple[np.ndarray, np.ndarray, int, np.ndarray]:
        """Pairs of cameras and triangles of mirrors that may be seen in them; tree nodes visited; what was given up."""
        # which side of its triangle the rays of a camera leave is asked once
        sides = self._upper_sides(mirror_map, cameras)
        return bounded_trace(self._mirror_tree, Cones.around(cameras), most, worth,
                             lambda camera, triangle: self._above(sides, camera, triangle))

    def first_met(self, sides: tuple[np.ndarray, np.ndarray], origin: np.ndarray, ray: np.ndarray) -> np.ndarray:
        """The triangle (n,) that each ray, from `origin` along unit vectors `ray` (3, n), meets first, -1 where none.
        They leave mirrors on `sides`, a place and a normal (3, n) each; what does not rise above is not met."""
        diffuse, near = first_crossed(self.tree, origin, ray)
        mirror, nearer = first_crossed(self._mirror_tree, origin, ray, ABOVE * self.size,
                                       lambda own, triangle: self._above(sides, own, triangle))
        return np.where(nearer < near, mirror + self.diffuse, diffuse)

    def first_distances(self, origin: np.ndarray, ray: np.ndarray) -> list[np.ndarray]:
        """How far along rays (3, n), unit vectors, the diffuse scene and the mirrors lie, infinite where not at all."""
        return [first_crossed(tree, origin, ray)[1] for tree in (self.tree, self._mirror_tree)]

    def shown_in_middles(self, mirror_map: ReflectionMap, cameras: Cameras) -> np.ndarray:
        """The triangle (n,) that the ray through the middle of each camera meets first, -1 where it meets none."""
        middle = np.take(cameras.places, cameras.corners.T, axis=1).mean(axis=1)
        origin, ray = mirror_map.leave(cameras.face, mirror_map.coordinates(cameras.face, middle))
        return self.first_met(self._upper_sides(mirror_map, cameras), origin, unit(ray))

    def hides(self, mirror_map: ReflectionMap, cameras: Cameras, camera: np.ndarray, places: np.ndarray,
              points: np.ndarray) -> np.ndarray:
        """Which of the `points` (3, n), seen at `places` (3, n) in the cameras (n,), lie behind a mirror."""
        owner, triangle, _, given_up = self._mirrors_in(mirror_map, cameras, MOST_PAIRS, np.ones(len(cameras)))
        order = np.argsort(owner, kind="stable")
        owner, triangle = owner[order], triangle[order]
        start = np.searchsorted(owner, camera)
        offered = np.searchsorted(owner, camera, side="right") - start
        hidden = np.zeros(len(camera), dtype=bool)
        # many images in cameras that may see much of a mirror are more pairs than memory holds
        for part in shares(offered, IMAGES_AT_ONCE):
            breathe()
            entry, image = ranges(start[part], offered[part])
            image += part.start
            met = self._passes(triangle[entry], places[:, image], points[:, image])
            hidden[image[met]] = True
        # where cameras see too much of the mirrors, each image is asked for by itself
        alone = np.flatnonzero(given_up[camera])
        zero, way = np.zeros(len(alone)), unit(points[:, alone] - places[:, alone])
        rays = Cones(places[:, alone], zero, way, zero, zero + 1.0)
        for image, triangle, _ in self._mirror_tree.traced(rays, np.ones(len(alone), dtype=bool)):
            met = self._passes(triangle, places[:, alone[image]], points[:, alone[image]])
            hidden[alone[image[met]]] = True
        return hidden

    def _passes(self, triangle: np.ndarray, places: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Whether the way from `places` (3, p) to `points` (3, p) passes through triangles (p,) of the mirrors."""
        a, b, c = np.moveaxis(np.take(self._mirror_corners, triangle, axis=1), 2, 0)
        way, offset = points - places, places - a
        normal, turned = cross(b - a, c - a), cross(offset, way)
        facing = -dot(way, normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = dot(offset, normal) / facing
            second, third = dot(turned, c - a) / facing, -dot(turned, b - a) / facing
            hit = (second >= 0.0) & (third >= 0.0) & (second + third <= 1.0)
            # a point on a mirror has no way to go
            length = norm(way)
            return hit & (share * length > ABOVE * self.size) & ((1.0 - share) * length > ABOVE * self.size)

    def _upper_sides(self, mirror_map: ReflectionMap, cameras: Cameras) -> tuple[np.ndarray, np.ndarray]:
        """The planes (n) of the cameras' flat triangles: a place on each, and its normal on the side that the rays
        leave."""
        surface, face = mirror_map.last(cameras.face)
        normal = surface.face_normal[:, face]
        return surface.a[:, face], normal * np.sign(dot(cameras.rays[:, cameras.corners].sum(axis=2), normal))

    def _above(self, sides: tuple[np.ndarray, np.ndarray], camera: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        """Whether triangles (p,) of the mirrors rise above the planes of the cameras (p,)."""
        base, normal = (np.take(side, camera, axis=1) for side in sides)
        found = np.zeros(len(camera), dtype=bool)
        for corner in range(3):
            offset = np.take(self._mirror_corners[:, :, corner], triangle, axis=1) - base
            found |= dot(offset, normal) > ABOVE * self.size
        return found

    def shows_mirror(self, frames: SceneFrames) -> np.ndarray:
        """Which columns (t,) of the frames are triangles of mirrors."""
        return frames.triangle >= self.diffuse

    def only_diffuse(self, frames: SceneFrames, candidates: Candidates) -> Candidates:
        """Candidates without the mirrors' triangles."""
        mirror = self.shows_mirror(frames)
        return candidates.select(np.flatnonzero(~mirror[candidates.column])) if mirror.any() else candidates

    def hiding_something(self, frames: SceneFrames, candidates: Candidates) -> Candidates:
        """Candidates without the mirrors' triangles in cameras that see nothing else, which hide nothing."""
        mirror = self.shows_mirror(frames)[candidates.column]
        diffuse = np.zeros(int(candidates.camera.max(initial=-1)) + 1, dtype=bool)
        diffuse[candidates.camera[~mirror]] = True
        return candidates.select(np.flatnonzero(~mirror | diffuse[candidates.camera]))

    def inner_sides(self, cameras: Cameras, frames: SceneFrames, candidates: Candidates) -> np.ndarray:
        """(3, p): sides of the candidates over which a mirror goes on, seen from anywhere in the camera. They bound
        nothing that is seen, as outlines do."""
        inner = np.zeros((3, len(candidates)), dtype=bool)
        pair = np.flatnonzero(self.shows_mirror(frames)[candidates.column])
        if not len(pair):
            return inner
        triangle = frames.triangle[candidates.column[pair]] - self.diffuse
        corners = cameras.corners[candidates.camera[pair]]
        origins = np.moveaxis(cameras.origins[:, corners], 2, 0)
        own = np.take(self._mirror_corners, triangle, axis=1)
        for side in range(3):
            beyond = np.take(self._beyond[:, :, side], triangle, axis=1)
            start, end = own[:, :, (side + 1) % 3], own[:, :, (side + 2) % 3]
            # a corner's place beside the plane through the side and a ray's origin is linear in the origin: three
            # corners of a camera speak for all of it
            planes = [cross(end - start, start - origin) for origin in origins]
            near, far = (np.sign([dot(plane, corner - start) for plane in planes]).sum(axis=0)
                         for corner in (own[:, :, side], beyond))
            inner[side, pair] = near * far == -9.0
        return inner

    def without_touching(self, mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames,
                         candidates: Candidates) -> Candidates:
        """Candidates without the mirrors' triangles that only touch the camera's own triangle in a corner or a side;
        those neighbours stay, as across a groove, that one of the camera's `_PROBES` sees, or the ray in the middle of
        what the neighbour covers."""
        pair = np.flatnonzero(self.shows_mirror(frames)[candidates.column])
        kept = np.ones(len(candidates), dtype=bool)
        for start in range(0, len(pair), PROBED_AT_ONCE):
            breathe()
            part = pair[start:start + PROBED_AT_ONCE]
            part = part[self._touching(mirror_map, cameras, frames, candidates.select(part))]
            asked = candidates.select(part)
            kept[part] = self._probed(cameras, frames, asked, np.repeat(_PROBES[:, :, None], len(part), axis=2))
            doubtful = np.flatnonzero(~kept[part])
            asked = asked.select(doubtful)
            covered = clip(asked)
            kept[part[doubtful[covered.pair]]] = self._probed(cameras, frames, asked.select(covered.pair),
                                                              covered.middles()[:, None])
        return candidates.select(kept) if len(pair) else candidates

    def _touching(self, mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames,
                  candidates: Candidates) -> np.ndarray:
        """Which candidates, all triangles of mirrors, share a corner or a side with the camera's own triangle."""
        surface, face = mirror_map.last(cameras.face[candidates.camera])
        own = surface.corners(face)
        other = np.take(self._mirror_corners, frames.triangle[candidates.column] - self.diffuse, axis=1)
        apart = np.abs(own[:, :, None] - np.swapaxes(other, 1, 2)[:, None]).max(axis=0)
        return np.flatnonzero((apart <= ABOVE * self.size).any(axis=(0, 1)))

    def _probed(self, cameras: Cameras, frames: SceneFrames, candidates: Candidates, probes: np.ndarray) -> np.ndarray:
        """Which candidates (p,), all of them triangles of mirrors, one of the rays with weights `probes` (3, k, p) in
        their cameras meets."""
        corners, count = cameras.corners[candidates.camera].T, probes.shape[1]
        origins, rays = (np.einsum("xkn,kpn->xpn", np.take(values, corners, axis=1), probes).reshape(3, -1)
                         for values in (cameras.origins, cameras.rays))
        probed = np.tile(candidates.column, count)
        s = frames.distance(probed, origins, rays)
        near = np.full(len(candidates), ABOVE * self.size)
        if cameras.origins is not cameras.places:
            # later cameras follow the sides of their triangles only nearly, and may begin a little behind the next
            corners = np.take(self._mirror_corners, frames.triangle[candidates.column] - self.diffuse, axis=1)
            near = BEHIND * np.ptp(corners, axis=2).max(axis=0)
        ahead = s * norm(rays) > np.tile(near, count)
        seen = ahead & (frames.weights(probed, origins + s * rays) > ABOVE).all(axis=0)
        return seen.reshape(count, -1).any(axis=0)


def first_crossed(tree: SceneTree | PointTree, origin: np.ndarray, ray: np.ndarray, beyond: float = 0.0,
                  asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The triangle (n,) of a tree that each ray (3, n), a unit vector, meets first farther than `beyond`, -1 where it
    meets none, and how far away, infinite there; of pairs (ray, triangle) only those that are `asked` for."""
    count = ray.shape[1]
    zero, first, best = np.zeros(count), np.full(count, -1), np.full(count, np.inf)
    if isinstance(tree, PointTree):
        return first, best
    for own, triangle, _ in tree.traced(Cones(origin, zero, ray, zero, zero + 1.0), np.ones(count, dtype=bool)):
        breathe()
        if asked is not None and len(own):
            kept = asked(own, triangle)
            own, triangle = own[kept], triangle[kept]
        a, b, c = (rows(tree.mesh.positions[tree.mesh.triangles[triangle, k]]) for k in range(3))
        s = _crossed(a, b, c, origin[:, own], ray[:, own])
        met = np.flatnonzero((s > beyond) & (s < best[own]))
        met = met[np.lexsort((triangle[met], s[met], own[met]))]
        found, nearest = np.unique(own[met], return_index=True)
        first[found], best[found] = triangle[met[nearest]], s[met[nearest]]
    return first, best


def _crossed(a: np.ndarray, b: np.ndarray, c: np.ndarray, origin: np.ndarray, ray: np.ndarray) -> np.ndarray:
    """How far along rays (3, n) they pass through triangles with corners (3, n), infinite where they do not.

    T. Moeller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 1997.
    """
    u, v, offset = b - a, c - a, origin - a
    turned, across = cross(ray, v), cross(offset, u)
    determinant = dot(u, turned)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        second, third = dot(offset, turned) / determinant, dot(ray, across) / determinant
        inside = (second >= 0.0) & (third >= 0.0) & (second + third <= 1.0)
        return np.where(inside, dot(v, across) / determinant, np.inf)


def _opposite(mesh: TriangleMesh) -> np.ndarray:
    """(m, 3, 3): the vertex of the one triangle that lies beyond each side, in the order of the vertices opposite; not
    a number where there is none or more than one. Sides are shared by place, not by index: flat faces may be apart."""
    _, welded = np.unique(mesh.positions, axis=0, return_inverse=True)
    triangles = welded.reshape(-1)[mesh.triangles]
    _, _, edge = shared_edges(triangles)
    # edge k runs from corner k to the next; the side opposite to corner j is edge j + 1
    edge = edge[:, [1, 2, 0]].ravel()
    order = np.argsort(edge, kind="stable")
    count = np.bincount(edge)
    pairs = order[np.flatnonzero(count[edge[order]] == 2)].reshape(-1, 2)
    beyond = np.full((len(edge), 3), np.nan)
    places = mesh.positions[mesh.triangles.ravel()]
    beyond[pairs[:, 0]], beyond[pairs[:, 1]] = places[pairs[:, 1]], places[pairs[:, 0]]
    return beyond.reshape(-1, 3, 3)
