"""All triangles that reflected rays may hit: those of the diffuse scene (everything that is not a mirror), and those of
mirrors that may be seen in a mirror; with queries for cameras and for rays.

A mirror occludes objects behind it, in its own reflection and in that of other mirrors. With a second bounce it also
reflects. From outside a convex mirror never sees itself: each triangle lies below the planes of all others.
"""
from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from ..cameras import Cameras, MirrorSurface
from ..geometry import Opacity, SceneFrames, TriangleMesh, columns, cross, dot, others, rows
from ..trees import Bound, Cones, Fronts, PointTree, SceneTree, Touching, first_crossed, first_of_many
from ..views import View
from .camera_families import traced
from .candidates import Candidates
from .convex_mirrors import outer_side
from .mirrors_shown import MirrorsShown
from .opacities import Opacities
from .scene_pieces import ScenePieces

ABOVE = 1e-9  # share of the size of mirrors or of a triangle: smaller heights above a plane are rounding
RISEN = 1e-5  # share of the mirrors' size: triangles less high above a plane are seen by grazing rays only


class SceneAndMirrors:
    """Triangles that rays may hit: first those of the diffuse scene, then those of the mirrors.

    Attributes
    ----------
    tree : SceneTree or PointTree, of the diffuse scene
    positions : (n, 3) float64, vertices in world space
    triangles : (m, 3) int64
    diffuse : int
        Number of diffuse triangles; later indices are triangles of mirrors. Diffuse are the scene's triangles, then the
        pieces, then the scene's triangles on merged vertices, if there are any.
    pieces : ScenePieces, optional
        Triangles left for the cameras of a patch; numbered after those of the scene.
    surface : MirrorSurface, of the mirrors
    reflecting : (k,) bool, True for mirror triangles that reflect; the others are occluders only
    given : (k,) int64, input index of each mirror triangle, before sorting
    mirror_tree : SceneTree
    mirror_corners : (3, m, 3) float64, corners of the mirrors' triangles, as [component, triangle, corner]
    size : float, longest side of the mirrors' bounding box, in scene units
    opacities : Opacities, of the diffuse triangles
    slide : float, factor on the distance by which layers move from the mirror towards the eye; 1 by default
    """

    def __init__(self, tree: SceneTree | PointTree, mirrors: TriangleMesh,
                 reflecting: np.ndarray | None = None, given: np.ndarray | None = None) -> None:
        self.reflecting = np.ones(len(mirrors.triangles), dtype=bool) if reflecting is None else reflecting
        self.given = np.arange(len(mirrors.triangles)) if given is None else given
        self.tree, self.mirrors, self.mirror_tree = tree, mirrors, SceneTree.of_ordered(mirrors)
        self.mirror_corners = rows(mirrors.positions[mirrors.triangles])
        self._corners = [rows(mirrors.positions[corner]) for corner in mirrors.triangles.T]
        self.size = float(np.ptp(mirrors.positions[mirrors.used], axis=0).max())
        self.surface = MirrorSurface(mirrors)
        self._beyond = rows(mirrors.opposite_corners)
        self.outward: np.ndarray | None = None
        self._fronts: list[Fronts | None] = [None, None]
        self._piece_fronts: Fronts | None = None
        self.opacities, self.slide = Opacities(), 1.0
        self._number(None)

    def with_opacity(self, opacity: np.ndarray | None) -> SceneAndMirrors:
        """Return a copy whose diffuse triangles have this `Opacity` (m,), in input order; None means all opaque."""
        opacities = Opacities.of(None if opacity is None else opacity[self.tree.given.triangle])
        if opacities.all_opaque:
            return self
        found = copy(self)
        found.opacities = opacities
        return found

    def sliding(self, share: float) -> SceneAndMirrors:
        """Return a copy with another `slide`: the factor on the distance of layers from the mirror."""
        found = copy(self)
        found.slide = share
        return found

    def from_outside(self, view: View) -> SceneAndMirrors:
        """Return a copy without the inner sides of closed bodies, for a view from outside of them."""
        seen = copy(self)
        trees = self.scene, self.mirror_tree
        outward = [tree.bodies.outward_from(view) for tree in trees]
        if self.opacities.of_scene is not None:
            # keep the inner sides of bodies with clear parts: they are seen through these
            outward[0] = np.where(self.scene.bodies.having(self.opacities.of_scene != Opacity.OPAQUE), 0.0, outward[0])
        seen.outward = outward[0]
        seen._fronts = [Fronts.of(tree.mesh, side) if side.any() else None for tree, side in zip(trees, outward)]
        return seen

    def _number(self, pieces: ScenePieces | None) -> None:
        mesh, mirrors, self.pieces = self.tree.mesh, self.mirrors, pieces
        positions = mesh.positions if pieces is None else pieces.mesh.positions
        triangles = [mesh.triangles] if pieces is None else [mesh.triangles, pieces.mesh.triangles]
        self._merged = sum(map(len, triangles))  # index of the first triangle on merged vertices
        if pieces is not None and pieces.merged is not None:
            triangles.append(pieces.merged)
        if pieces is not None:
            self.opacities = self.opacities.with_pieces(
                [pieces.source] + [np.arange(len(mesh.triangles))] * (pieces.merged is not None))
        self.diffuse = sum(map(len, triangles))
        self.positions = np.concatenate((positions, mirrors.positions))
        self.triangles = np.concatenate((*triangles, mirrors.triangles + len(positions)))

    def left_to(self, pieces: ScenePieces) -> SceneAndMirrors:
        """Return a copy in which the cameras of a patch see only these pieces of the scene."""
        left = copy(self)
        left._number(pieces)
        if self.outward is not None:
            left._piece_fronts = Fronts.of(pieces.mesh, self.outward[pieces.source])
        return left

    def sources(self, triangle: np.ndarray) -> np.ndarray:
        """Return the whole triangles (n,) that diffuse triangles (n,) lie in, as indices into `triangles`.

        For pieces on merged vertices this is the scene's triangle on merged vertices.
        """
        if self.pieces is None:
            return triangle
        whole = len(self.tree.mesh.triangles)
        return np.where(triangle < whole, triangle,
                        self.on_patch(np.append(self.pieces.source, 0)[np.maximum(triangle - whole, 0)]))

    def on_patch(self, source: np.ndarray) -> np.ndarray:
        """Return the indices (n,) of triangles `source` (n,) as the patch shows them: on merged vertices, if any."""
        return source if self.pieces is None or self.pieces.merged is None else source + self._merged

    def of_scene(self, source: np.ndarray) -> np.ndarray:
        """Return the scene's triangles (n,) for results (n,) of `sources` and `on_patch`: the inverse of `on_patch`."""
        return np.where(source < self._merged, source, source - self._merged)

    @property
    def scene(self) -> SceneTree:
        """The tree of a diffuse scene with triangles; not valid for a `PointTree`."""
        assert isinstance(self.tree, SceneTree)
        return self.tree

    @property
    def bounds(self) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius of a bounding sphere of the diffuse scene."""
        sphere = self.tree.spheres[0][:, 0]
        return sphere[:3], float(sphere[3])

    def showing_mirrors(self, cameras: Cameras, most: int) -> MirrorsShown:
        """Find the mirrors that cameras may show.

        If more than `most` pairs of a camera and a triangle are found, some cameras are given up: they may show any
        mirror.
        """
        found = self.mirrors_in(cameras, Bound(most, np.ones(len(cameras))))
        risen = self._above(self.upper_sides(cameras), found.cone, found.triangle, RISEN)
        return MirrorsShown.of(cameras, (found.cone, found.triangle), risen, found.given_up)

    def showing_scene(self, cameras: Cameras) -> np.ndarray:
        """Return True (n,) for cameras that may show the diffuse scene."""
        centre, radius = self.bounds
        count = len(cameras)
        found = Cones.around(cameras).touch(np.arange(count), np.repeat(centre[:, None], count, axis=1),
                                            np.full(count, radius))
        if self.pieces is not None:
            on_patch = np.flatnonzero(self.pieces.holds(cameras))
            found[on_patch] &= self.pieces.shown(cameras.select(on_patch))
        return found

    def diffuse_in(self, cameras: Cameras, bound: Bound) -> Touching:
        """Find pairs of a camera and a diffuse triangle that it may see."""
        if self.pieces is None:
            return traced(self.scene, cameras, bound, self._fronts[0])
        on_patch = self.pieces.holds(cameras)
        found = []
        for tree, first, own, fronts in ((self.scene, 0, ~on_patch, self._fronts[0]),
                                         (self.pieces.tree, len(self.tree.mesh.triangles), on_patch,
                                          self._piece_fronts)):
            chosen = np.flatnonzero(own)
            part = traced(tree, cameras.select(chosen), bound.select(chosen), fronts).among(chosen, len(cameras))
            found.append(replace(part, triangle=first + part.triangle))
        return Touching.joined(found)

    @cached_property
    def _outside(self) -> float:
        return outer_side(self.mirrors, self.surface, self._beyond, RISEN * self.size)

    def mirrors_in(self, cameras: Cameras, bound: Bound, before: MirrorsShown | None = None) -> Touching:
        """Find pairs of a camera and a mirror triangle that it may see; cameras in the cache `before` are looked up."""
        if before is not None:
            camera, triangle, known = before.known(cameras)
            asked = np.flatnonzero(~known)
            found = self.mirrors_in(cameras.select(asked), bound.select(asked).beside(len(camera)))
            return Touching.joined([replace(Touching.none(len(cameras)), cone=camera, triangle=triangle),
                                    found.among(asked, len(cameras))])
        # compute once on which side of its triangle a camera's rays leave
        sides = self.upper_sides(cameras)
        if len(cameras) and self._outside and cameras.mirror_map.bounce == 1:
            surface, face = cameras.mirror_map.last(cameras.face)
            if (self._outside * dot(sides[1], surface.face_normal[:, face]) > 0.0).all():
                return Touching.none(len(cameras))
        return traced(self.mirror_tree, cameras, bound, self._fronts[1],
                       lambda camera, triangle: self._above(sides, camera, triangle))

    def first_met(self, sides: tuple[np.ndarray, np.ndarray], origin: np.ndarray, ray: np.ndarray,
                  many: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Trace rays to the first triangle that they hit.

        Parameters
        ----------
        sides : tuple
            A place and a normal (3, n) of the mirror plane that each ray leaves. Mirrors not above it cannot be hit.
        origin, ray : (3, n) float64, starts and unit directions
        many : bool, True if the rays are a part of a large set: chooses the traversal

        Returns
        -------
        triangle : (n,) int64, index into `triangles`, -1 for none
        distance : (n,) float64, infinite for none
        """
        first = first_of_many if many else first_crossed
        diffuse, near = first(self.scene, origin, ray)
        mirror, nearer = first(self.mirror_tree, origin, ray, ABOVE * self.size,
                                       lambda own, triangle: self._above(sides, own, triangle))
        return np.where(nearer < near, mirror + self.diffuse, diffuse), np.minimum(near, nearer)

    def hidden_within(self, origin: np.ndarray, ray: np.ndarray, reach: np.ndarray,
                      many: bool = False) -> np.ndarray:
        """Return True (n,) for rays from a mirror that hit a diffuse triangle that layers must not cover.

        Only hits within `reach` (n,) count. `origin` and unit vectors `ray` are (3, n); `many` as for `first_met`.
        """
        first = first_of_many if many else first_crossed
        return first(self.scene, origin, ray, ABOVE * self.size, self._if_seen(), limit=reach)[0] >= 0

    def _if_seen(self) -> Callable[[np.ndarray, np.ndarray], np.ndarray] | None:
        """Return a filter for pairs of an eye ray and a triangle that count as hits; None if all do."""
        return None if self.opacities.all_opaque else lambda _, triangle: self.opacities.not_to_cover(triangle)

    def first_distances(self, origin: np.ndarray, ray: np.ndarray, diffuse: bool) -> np.ndarray:
        """Return the distance (n,) to the first hit of eye rays, infinite for none.

        `origin` and unit vectors `ray` are (3, n). If `diffuse` is True, mirrors are ignored.
        """
        near = first_crossed(self.scene, origin, ray, asked=self._if_seen())[1]
        return near if diffuse else np.minimum(near, first_crossed(self.mirror_tree, origin, ray)[1])

    def upper_sides(self, cameras: Cameras) -> tuple[np.ndarray, np.ndarray]:
        """Return the planes of the cameras' flat triangles: a place (3, n) on each, and its unit normal (3, n).

        The normal points to the side on which the rays leave.
        """
        mirror_map = cameras.mirror_map
        surface, face = mirror_map.last(cameras.face)
        normal = surface.face_normal[:, face]
        return surface.a[:, face], normal * np.sign(dot(cameras.rays[:, cameras.corners].sum(axis=2), normal))

    def _above(self, sides: tuple[np.ndarray, np.ndarray], camera: np.ndarray, triangle: np.ndarray,
               least: float = ABOVE) -> np.ndarray:
        """Return True (p,) for pairs of a camera and a mirror triangle that rises above the camera's plane.

        `sides` are the planes of all cameras. Heights up to `least`, a share of the mirrors' size, do not count.
        """
        base, normal = (columns(side, camera) for side in sides)
        found = np.zeros(len(camera), dtype=bool)
        for corners in self._corners:
            found |= dot(columns(corners, triangle) - base, normal) > least * self.size
        return found

    def shows_mirror(self, frames: SceneFrames) -> np.ndarray:
        """Return True (t,) for columns of the frames that are mirror triangles."""
        return frames.triangle >= self.diffuse

    def reflects(self, frames: SceneFrames) -> np.ndarray:
        """Return True (t,) for columns of the frames that are mirror triangles that reflect."""
        shows = self.shows_mirror(frames)
        return shows & self.reflecting[np.where(shows, frames.triangle - self.diffuse, 0)]

    def are_mirrors(self, candidates: Candidates) -> np.ndarray:
        """Return True (p,) for candidates whose triangle is a mirror."""
        return self.shows_mirror(candidates.frames)[candidates.column]

    def only_diffuse(self, candidates: Candidates) -> Candidates:
        """Return the candidates without mirror triangles."""
        mirror = self.are_mirrors(candidates)
        return candidates.select(np.flatnonzero(~mirror)) if mirror.any() else candidates

    def inner_sides(self, candidates: Candidates) -> np.ndarray:
        """Return True (3, p) for sides of mirror triangles that are no outline, seen from anywhere in the camera.

        The mirror continues across such a side, on its other side in the picture.
        """
        cameras, frames = candidates.cameras, candidates.frames
        inner = np.zeros((3, len(candidates)), dtype=bool)
        pair = np.flatnonzero(self.are_mirrors(candidates))
        if not len(pair):
            return inner
        triangle = frames.triangle[candidates.column[pair]] - self.diffuse
        origins = [columns(cameras.origins, corner) for corner in cameras.corners[candidates.camera[pair]].T]
        own = [columns(corners, triangle) for corners in self._corners]
        for side in range(3):
            beyond = columns(self._beyond[:, :, side], triangle)
            start, end = (own[corner] for corner in others(side))
            # the distance of a corner from the plane through the side and a ray's origin is linear in the origin: test
            # the three corners of a camera
            planes = [cross(end - start, start - origin) for origin in origins]
            near, far = (np.sign([dot(plane, corner - start) for plane in planes]).sum(axis=0)
                         for corner in (own[side], beyond))
            inner[side, pair] = near * far == -9.0
        return inner
