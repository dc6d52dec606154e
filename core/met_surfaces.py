"""What rays that leave a mirror may meet: the diffuse scene, and the mirrors themselves where they can be seen in it.

A mirror hides what lies behind it in its own reflection, as it does in that of others, and where a second bounce is
asked for it is the next mirror. Convex mirrors never see themselves: their triangles all lie below each other's planes.
"""
from __future__ import annotations

import numpy as np

from .bounded_trace import bounded_trace
from .cameras import Cameras
from .candidates import Candidates
from .cones import Cones
from .mirror_surface import MirrorSurface
from .point_tree import PointTree
from .reflection_map import ReflectionMap
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .triangle_mesh import TriangleMesh
from .subdivision import shared_edges
from .vectors import cross, dot, norm, ranges, rows, shares

IMAGES_AT_ONCE = 500_000  # pairs of an image and a triangle of a mirror that may hide it
ABOVE = 1e-9  # of the mirrors' size, or of a triangle's: what rises less above a plane touches it by rounding
BEHIND = 0.02  # of a triangle's size

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
        """Which faces of the map, by their number, may show a mirror in any of the cameras; more than `most` pairs of
        cameras and triangles are refused."""
        camera, _, _ = self._mirrors_in(mirror_map, cameras, most)
        found = np.zeros(int(cameras.face.max(initial=-1)) + 1, dtype=bool)
        found[cameras.face[camera]] = True
        return found

    def showing_scene(self, cameras: Cameras) -> np.ndarray:
        """Which cameras (n,) may show the diffuse scene."""
        centre, radius = self.bounds
        count = len(cameras)
        return Cones.around(cameras).touch(np.arange(count), np.repeat(centre[:, None], count, axis=1),
                                           np.full(count, radius))

    def trace(self, mirror_map: ReflectionMap, cameras: Cameras, showing: np.ndarray,
              most: int) -> tuple[np.ndarray, np.ndarray, int]:
        """Pairs of cameras and triangles that may be seen in them, and how many tree nodes were visited for that;
        mirrors are looked for on the faces that `showing_mirrors` found. More than `most` pairs are refused."""
        camera, triangle, visited = bounded_trace(self.tree, Cones.around(cameras), most)
        chosen = np.flatnonzero(showing[cameras.face])
        mirror_camera, mirror_triangle, more = self._mirrors_in(mirror_map, cameras.select(chosen), most)
        return (np.concatenate((camera, chosen[mirror_camera])),
                np.concatenate((triangle, mirror_triangle + self.diffuse)), visited + more)

    def _mirrors_in(self, mirror_map: ReflectionMap, cameras: Cameras,
                    most: float = np.inf) -> tuple[np.ndarray, np.ndarray, int]:
        """Pairs of cameras and triangles of mirrors that may be seen in them; tree nodes visited."""
        if not len(cameras):
            return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), 0
        return bounded_trace(self._mirror_tree, Cones.around(cameras), most,
                       lambda camera, triangle: self._above(mirror_map, cameras, camera, triangle))

    def hides(self, mirror_map: ReflectionMap, cameras: Cameras, camera: np.ndarray, places: np.ndarray,
              points: np.ndarray) -> np.ndarray:
        """Which of the `points` (3, n), seen at `places` (3, n) in the cameras (n,), lie behind a mirror."""
        owner, triangle, _ = self._mirrors_in(mirror_map, cameras)
        order = np.argsort(owner, kind="stable")
        owner, triangle = owner[order], triangle[order]
        start = np.searchsorted(owner, camera)
        offered = np.searchsorted(owner, camera, side="right") - start
        hidden = np.zeros(len(camera), dtype=bool)
        # many images in cameras that may see much of a mirror are more pairs than memory holds
        for part in shares(offered, IMAGES_AT_ONCE):
            entry, image = ranges(start[part], offered[part])
            image += part.start
            met = self._passes(triangle[entry], places[:, image], points[:, image])
            hidden[image[met]] = True
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
        length = norm(way)
        return hit & (share * length > ABOVE * self.size) & ((1.0 - share) * length > ABOVE * self.size)

    def _above(self, mirror_map: ReflectionMap, cameras: Cameras, camera: np.ndarray,
               triangle: np.ndarray) -> np.ndarray:
        """Whether triangles rise above the planes of the cameras' flat triangles, on the side that the rays leave."""
        surface, face = mirror_map.last(cameras.face)
        normal, base = surface.face_normal[:, face], surface.a[:, face]
        side = np.sign(dot(cameras.rays[:, cameras.corners].sum(axis=2), normal))
        found = np.zeros(len(camera), dtype=bool)
        for corner in range(3):
            offset = np.take(self._mirror_corners[:, :, corner], triangle, axis=1) - np.take(base, camera, axis=1)
            found |= dot(offset, np.take(normal, camera, axis=1)) * side[camera] > ABOVE * self.size
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
        those neighbours stay that one of the camera's `_PROBES` sees, as across a groove."""
        pair = np.flatnonzero(self.shows_mirror(frames)[candidates.column])
        if not len(pair):
            return candidates
        surface, face = mirror_map.last(cameras.face[candidates.camera[pair]])
        own = surface.corners(face)
        other = np.take(self._mirror_corners, frames.triangle[candidates.column[pair]] - self.diffuse, axis=1)
        apart = np.abs(own[:, :, None] - np.swapaxes(other, 1, 2)[:, None]).max(axis=0)
        touching = (apart <= ABOVE * self.size).any(axis=(0, 1))
        pair = pair[touching]
        corners = cameras.corners[candidates.camera[pair]].T
        origins, rays = (np.einsum("xkn,kp->xpn", np.take(values, corners, axis=1), _PROBES).reshape(3, -1)
                         for values in (cameras.origins, cameras.rays))
        column = np.tile(candidates.column[pair], _PROBES.shape[1])
        s = frames.distance(column, origins, rays)
        near = np.full(len(pair), ABOVE * self.size)
        if cameras.origins is not cameras.places:
            # later cameras follow the sides of their triangles only nearly, and may begin a little behind the next
            near = BEHIND * np.ptp(other, axis=2).max(axis=0)[touching]
        ahead = s * norm(rays) > np.tile(near, _PROBES.shape[1])
        seen = ahead & (frames.weights(column, origins + s * rays) > ABOVE).all(axis=0)
        kept = np.ones(len(candidates), dtype=bool)
        if not len(pair):
            return candidates
        kept[pair] = seen.reshape(-1, len(pair)).any(axis=0)
        return candidates.select(kept)


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
