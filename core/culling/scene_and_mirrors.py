"""What rays that leave a mirror may meet: the diffuse scene, and the mirrors themselves where they can be seen in it.

A mirror hides what lies behind it in its own reflection, as it does in that of others, and where a second bounce is
asked for it is the next mirror. Convex mirrors never see themselves: their triangles all lie below each other's planes.
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

ABOVE = 1e-9  # of the mirrors' size, or of a triangle's: what rises less above a plane touches it by rounding
RISEN = 1e-5  # of the mirrors' size: what rises less is seen by rays along the mirror alone


class SceneAndMirrors:
    """Triangles that may be met: those of the diffuse scene, and behind them those of the mirrors.

    Attributes
    ----------
    tree : SceneTree or PointTree, of the diffuse scene
    positions : (n, 3) float64
    triangles : (m, 3) int64
    diffuse : int
        How many triangles are diffuse, pieces of some among them, and behind these all as they are drawn together; the
        others are the mirrors'.
    pieces : ScenePieces, optional
        What is left to the cameras of a patch; their triangles are numbered behind those of the scene.
    surface : MirrorSurface, of the mirrors
    reflecting : (k,) bool, which triangles of the mirrors reflect; the others only hide what lies behind them
    given : (k,) int64, the triangle that each of the mirrors' was before they were put in order
    mirror_tree : SceneTree
    mirror_corners : (3, m, 3) float64, of the mirrors' triangles, as [component, triangle, corner]
    size : float, of the mirrors: the longest side of the box round them, in scene units
    opacities : Opacities, of the diffuse triangles
    slide : float, share of what layers slide before other mirrors
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
        """The same, of a scene whose triangles (m,), as they were given, have this `Opacity`, or are all opaque."""
        opacities = Opacities.of(None if opacity is None else opacity[self.tree.given.triangle])
        if opacities.all_opaque:
            return self
        found = copy(self)
        found.opacities = opacities
        return found

    def sliding(self, share: float) -> SceneAndMirrors:
        """The same, before which layers slide by this share of what they slide elsewhere."""
        found = copy(self)
        found.slide = share
        return found

    def from_outside(self, view: View) -> SceneAndMirrors:
        """The same, without what closed bodies turn away from the view, which looks from outside."""
        seen = copy(self)
        trees = self.scene, self.mirror_tree
        outward = [tree.bodies.outward_from(view) for tree in trees]
        if self.opacities.of_scene is not None:
            # through the open parts of a body its inner side is seen
            outward[0] = np.where(self.scene.bodies.having(self.opacities.of_scene != Opacity.OPAQUE), 0.0, outward[0])
        seen.outward = outward[0]
        seen._fronts = [Fronts.of(tree.mesh, side) if side.any() else None for tree, side in zip(trees, outward)]
        return seen

    def _number(self, pieces: ScenePieces | None) -> None:
        mesh, mirrors, self.pieces = self.tree.mesh, self.mirrors, pieces
        positions = mesh.positions if pieces is None else pieces.mesh.positions
        triangles = [mesh.triangles] if pieces is None else [mesh.triangles, pieces.mesh.triangles]
        self._merged = sum(map(len, triangles))  # the first that is drawn together
        if pieces is not None and pieces.merged is not None:
            triangles.append(pieces.merged)
        if pieces is not None:
            self.opacities = self.opacities.with_pieces(
                [pieces.source] + [np.arange(len(mesh.triangles))] * (pieces.merged is not None))
        self.diffuse = sum(map(len, triangles))
        self.positions = np.concatenate((positions, mirrors.positions))
        self.triangles = np.concatenate((*triangles, mirrors.triangles + len(positions)))

    def left_to(self, pieces: ScenePieces) -> SceneAndMirrors:
        """The same, where the cameras of a patch have to show these pieces alone."""
        left = copy(self)
        left._number(pieces)
        if self.outward is not None:
            left._piece_fronts = Fronts.of(pieces.mesh, self.outward[pieces.source])
        return left

    def sources(self, triangle: np.ndarray) -> np.ndarray:
        """The triangles that diffuse triangles (n,) lie in: of the scene, or as they are drawn together."""
        if self.pieces is None:
            return triangle
        whole = len(self.tree.mesh.triangles)
        return np.where(triangle < whole, triangle,
                        self.on_patch(np.append(self.pieces.source, 0)[np.maximum(triangle - whole, 0)]))

    def on_patch(self, source: np.ndarray) -> np.ndarray:
        """Triangles (n,) of the scene as whole faces and pieces show them, drawn together if any are."""
        return source if self.pieces is None or self.pieces.merged is None else source + self._merged

    def of_scene(self, source: np.ndarray) -> np.ndarray:
        """The triangles of the scene that `sources` and `on_patch` (n,) are."""
        return np.where(source < self._merged, source, source - self._merged)

    @property
    def scene(self) -> SceneTree:
        """The diffuse scene, where it is one of triangles: points have a trace of their own."""
        assert isinstance(self.tree, SceneTree)
        return self.tree

    @property
    def bounds(self) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius of a sphere round the diffuse scene."""
        sphere = self.tree.spheres[0][:, 0]
        return sphere[:3], float(sphere[3])

    def showing_mirrors(self, cameras: Cameras, most: int) -> MirrorsShown:
        """The mirrors that cameras may show; those for which more than `most` pairs of cameras and triangles would have
        to be looked at may show any."""
        found = self.mirrors_in(cameras, Bound(most, np.ones(len(cameras))))
        risen = self._above(self.upper_sides(cameras), found.cone, found.triangle, RISEN)
        return MirrorsShown.of(cameras, (found.cone, found.triangle), risen, found.given_up)

    def showing_scene(self, cameras: Cameras) -> np.ndarray:
        """Which cameras (n,) may show the diffuse scene."""
        centre, radius = self.bounds
        count = len(cameras)
        found = Cones.around(cameras).touch(np.arange(count), np.repeat(centre[:, None], count, axis=1),
                                            np.full(count, radius))
        if self.pieces is not None:
            on_patch = np.flatnonzero(self.pieces.holds(cameras))
            found[on_patch] &= self.pieces.shown(cameras.select(on_patch))
        return found

    def diffuse_in(self, cameras: Cameras, bound: Bound) -> Touching:
        """Cameras and diffuse triangles that may be seen in them."""
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
        """Cameras and triangles of mirrors that may be seen in them. What was found `before` is not looked for
        again."""
        if before is not None:
            camera, triangle, known = before.known(cameras)
            asked = np.flatnonzero(~known)
            found = self.mirrors_in(cameras.select(asked), bound.select(asked).beside(len(camera)))
            return Touching.joined([replace(Touching.none(len(cameras)), cone=camera, triangle=triangle),
                                    found.among(asked, len(cameras))])
        # which side of its triangle the rays of a camera leave is asked once
        sides = self.upper_sides(cameras)
        if len(cameras) and self._outside and cameras.mirror_map.bounce == 1:
            surface, face = cameras.mirror_map.last(cameras.face)
            if (self._outside * dot(sides[1], surface.face_normal[:, face]) > 0.0).all():
                return Touching.none(len(cameras))
        return traced(self.mirror_tree, cameras, bound, self._fronts[1],
                       lambda camera, triangle: self._above(sides, camera, triangle))

    def first_met(self, sides: tuple[np.ndarray, np.ndarray], origin: np.ndarray, ray: np.ndarray,
                  many: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """The triangle (n,) that each ray, from `origin` along unit vectors `ray` (3, n), meets first, -1 where none;
        and how far away. They leave mirrors on `sides`, a place and a normal (3, n) each; what does not rise above is
        not met. They may be some of `many`."""
        first = first_of_many if many else first_crossed
        diffuse, near = first(self.scene, origin, ray)
        mirror, nearer = first(self.mirror_tree, origin, ray, ABOVE * self.size,
                                       lambda own, triangle: self._above(sides, own, triangle))
        return np.where(nearer < near, mirror + self.diffuse, diffuse), np.minimum(near, nearer)

    def hidden_within(self, origin: np.ndarray, ray: np.ndarray, reach: np.ndarray,
                      many: bool = False) -> np.ndarray:
        """Return True for rays (3, n), unit vectors, that meet something of the diffuse scene that must not be covered,
        within `reach` (n,) of where they begin, on a mirror. They may be some of `many`."""
        first = first_of_many if many else first_crossed
        return first(self.scene, origin, ray, ABOVE * self.size, self._if_seen(), limit=reach)[0] >= 0

    def _if_seen(self) -> Callable[[np.ndarray, np.ndarray], np.ndarray] | None:
        """Tell which pairs of a ray and a triangle count for rays of the eye; None if all do."""
        return None if self.opacities.all_opaque else lambda _, triangle: self.opacities.not_to_cover(triangle)

    def first_distances(self, origin: np.ndarray, ray: np.ndarray, diffuse: bool) -> np.ndarray:
        """Distances (n,) along rays (3, n) of the eye, unit vectors, of what it sees of the diffuse scene, or of this
        and the mirrors; infinite for rays that meet none."""
        near = first_crossed(self.scene, origin, ray, asked=self._if_seen())[1]
        return near if diffuse else np.minimum(near, first_crossed(self.mirror_tree, origin, ray)[1])

    def upper_sides(self, cameras: Cameras) -> tuple[np.ndarray, np.ndarray]:
        """The planes (n) of the cameras' flat triangles: a place on each, and its normal on the side that the rays
        leave."""
        mirror_map = cameras.mirror_map
        surface, face = mirror_map.last(cameras.face)
        normal = surface.face_normal[:, face]
        return surface.a[:, face], normal * np.sign(dot(cameras.rays[:, cameras.corners].sum(axis=2), normal))

    def _above(self, sides: tuple[np.ndarray, np.ndarray], camera: np.ndarray, triangle: np.ndarray,
               least: float = ABOVE) -> np.ndarray:
        """Whether triangles (p,) of mirrors rise above the planes of the cameras (p,), by more than the `least` part
        of the mirrors' size."""
        base, normal = (columns(side, camera) for side in sides)
        found = np.zeros(len(camera), dtype=bool)
        for corners in self._corners:
            found |= dot(columns(corners, triangle) - base, normal) > least * self.size
        return found

    def shows_mirror(self, frames: SceneFrames) -> np.ndarray:
        """Which columns (t,) of the frames are triangles of mirrors."""
        return frames.triangle >= self.diffuse

    def reflects(self, frames: SceneFrames) -> np.ndarray:
        """Which columns (t,) of the frames are triangles of mirrors from which light goes on."""
        shows = self.shows_mirror(frames)
        return shows & self.reflecting[np.where(shows, frames.triangle - self.diffuse, 0)]

    def are_mirrors(self, candidates: Candidates) -> np.ndarray:
        """Which candidates (p,) are triangles of mirrors."""
        return self.shows_mirror(candidates.frames)[candidates.column]

    def only_diffuse(self, candidates: Candidates) -> Candidates:
        """Candidates without the mirrors' triangles."""
        mirror = self.are_mirrors(candidates)
        return candidates.select(np.flatnonzero(~mirror)) if mirror.any() else candidates

    def inner_sides(self, candidates: Candidates) -> np.ndarray:
        """(3, p): sides of the candidates over which a mirror goes on, seen from anywhere in the camera. They bound
        nothing that is seen, as outlines do."""
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
            # a corner's place beside the plane through the side and a ray's origin is linear in the origin: three
            # corners of a camera speak for all of it
            planes = [cross(end - start, start - origin) for origin in origins]
            near, far = (np.sign([dot(plane, corner - start) for plane in planes]).sum(axis=0)
                         for corner in (own[side], beyond))
            inner[side, pair] = near * far == -9.0
        return inner
