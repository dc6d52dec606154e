"""Unwrap reflections by where the camera sees them: a place in one picture for each face, and the light path of each
texel.

A texel is as large as a share of a pixel. Faces behind one another lie on pages of their own, side by side in the
picture, so that each keeps its light if what hides it is taken away.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import bpy
import numpy as np

from ...core import View, breathe, draw, pages_of
from ...core.result import place
from ..reading import corner_vertices, numbers, vectors
from ..reading.materials import is_displaced
from ..writing import ARRIVAL, NORMAL
from .light_paths import LightPaths
from .world_faces import WORLD, lies_on_mirror, world_targets

MARGIN = 5          # texels around each page
NEAREST, FARTHEST = 1e-4, 0.25  # bounds of a path's lead
ROOM = 1.4          # distances to the mirror across which a texel may reach, half of it to either side
FROM_MIRROR = 1.0 - 1e-5    # lead of a path that begins at the mirror
POINT_LEAD = 1e-3   # the same for points, which lie at vertices
SEEN_LEAD = 2e-5    # the same for paths from the eye to a reflection, whose layers lie close together


@dataclass(frozen=True)
class Faces:
    """The faces of a reflection in world space: corners are of triangles (m, 3).

    Attributes
    ----------
    positions : (n, 3) float64, where the mesh lies
    images : (n, 3) float64, which hide each other as the faces do, before and behind the same pixels
    corners : (m, 3) int64, vertices of each face
    targets, origins : (m, 3, 3) float64, ends of the light path of each corner
    sky : (m,) bool, faces that show the world
    displaced : (m,) bool, faces of which renders move the source: it is looked for from the mirror on
    normals : (m, 3, 3) float64, of the mirror at the corners; zero after several mirrors
    """

    positions: np.ndarray
    images: np.ndarray
    corners: np.ndarray
    targets: np.ndarray
    origins: np.ndarray
    sky: np.ndarray
    displaced: np.ndarray
    normals: np.ndarray

    @classmethod
    def joined(cls, parts: list[Faces]) -> Faces:
        """Return the faces of all parts as one."""
        parts = [cls.none(), *parts]
        starts = np.cumsum([0, *(len(one.positions) for one in parts)])
        corners = np.concatenate([one.corners + start for one, start in zip(parts, starts)])
        others = {name: np.concatenate([getattr(one, name) for one in parts])
                  for name in ("positions", "images", "targets", "origins", "sky", "displaced", "normals")}
        return cls(corners=corners, **others)

    @classmethod
    def none(cls) -> Faces:
        none, ends = np.zeros((0, 3)), np.zeros((0, 3, 3))
        return cls(none, none, none.astype(np.int64), ends, ends, *np.zeros((2, 0), dtype=bool), ends)


class Placed(NamedTuple):
    """A reflection's mesh, the matrix (4, 4) that places it where it was generated, and whether faces that others hide
    need light of their own."""

    mesh: bpy.types.Mesh
    matrix: np.ndarray
    layered: bool

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) float64, in world space."""
        return vectors(self.mesh, "position") @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    @property
    def has_faces(self) -> bool:
        return len(self.mesh.polygons) > 0


@dataclass(frozen=True)
class Unwrapped:
    """Reflections unwrapped into one picture.

    Attributes
    ----------
    size : (width, height) in texels
    spots : list of (m, 3, 2) float64, from 0 to 1 in the camera's view, for each reflection with faces; (n, 2) for one
        of points
    blocks : list of FaceBlock and PointBlock
    """

    size: tuple[int, int]
    spots: list
    blocks: list

    def paths(self, seen: bool = False) -> LightPaths:
        """Return the light path of each texel; the path from the eye to the reflection itself if `seen`."""
        paths = LightPaths.empty(self.size[1], self.size[0])
        for block in self.blocks:
            block.draw(paths, seen)
        return paths


def unwrap(placed: list[Placed], view: View, dense: int) -> Unwrapped:
    """Unwrap reflections as `view` sees them, with `dense` texels along each side of a pixel.

    Parameters
    ----------
    placed : list of Placed
        Whose meshes have the attributes `reflected_position` and `mirror_position`.
    """
    fine = replace(view, resolution=tuple(side * dense for side in view.resolution))
    faces = [faces_of(one, view) for one in placed if one.has_faces]
    joined = Faces.joined(faces)
    pixels = fine.pixels(joined.positions)[joined.corners]
    layered = any(one.layered for one in placed)
    page = (pages_of(fine, joined.images, joined.corners) if layered
            else np.zeros(len(joined.corners), dtype=np.int64))
    blocks: list = [FaceBlock.around(fine, joined, own, pixels[own])
                    for own in (np.flatnonzero(page == number) for number in np.unique(page))]
    blocks += [PointBlock(one, view) for one in placed if not one.has_faces]
    size = _pack(blocks)
    spots, of_points = np.zeros((len(joined.corners), 3, 2)), []
    for block in blocks:
        if isinstance(block, FaceBlock):
            spots[block.own] = (pixels[block.own] + block.shift) / size
        else:
            of_points.append(block.spots(size))
    # beside the camera's view places are linear on a face, too
    spots = np.clip(np.nan_to_num(spots), -1.0, 2.0)
    with_faces = iter(np.split(spots, np.cumsum([len(one.corners) for one in faces])[:-1]))
    without = iter(of_points)
    return Unwrapped(size, [next(with_faces if one.has_faces else without) for one in placed], blocks)


def faces_of(placed: Placed, view: View) -> Faces:
    """Read the faces of a reflection that `view` sees, and the light path of each corner."""
    mesh = placed.mesh
    corners = corner_vertices(mesh).astype(np.int64)
    target, origin = vectors(mesh, "reflected_position")[corners], vectors(mesh, "mirror_position")[corners]
    sky, normals = numbers(mesh, "source_object") == WORLD, vectors(mesh, NORMAL)[corners]
    if ARRIVAL in mesh.attributes:
        # light that met several mirrors arrives from the last one
        later = numbers(mesh, "bounces") > 1
        origin[later] = target[later] - vectors(mesh, ARRIVAL)[corners[later]]
        normals[later] = 0.0
    positions = images = placed.positions
    if lies_on_mirror(mesh, positions):
        # all in one plane: what they show tells which is before another
        images = place(view, vectors(mesh, "mirror_position").T, numbers(mesh, "path_length"), "VIRTUAL").T
    displaced = np.array([is_displaced(one) for one in mesh.materials] or [False])
    slot = np.zeros(len(corners), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", slot)
    displaced = displaced[np.minimum(slot, len(displaced) - 1)] & ~sky
    return Faces(positions, images, corners, target, origin, sky, displaced, normals)


@dataclass
class FaceBlock:
    """A rectangle of texels for faces of which none hides another one.

    Attributes
    ----------
    fine : View, whose pixels are texels
    faces : Faces, and which of them are in the block: `own` (k,)
    low, size : (2,) int64, lowest column and row in the view, and width and height
    corner : (2,) int64, the lowest column and row in the picture
    """

    fine: View
    faces: Faces
    own: np.ndarray
    pixels: np.ndarray
    low: np.ndarray
    size: np.ndarray
    corner: np.ndarray

    @classmethod
    def around(cls, fine: View, faces: Faces, own: np.ndarray, pixels: np.ndarray) -> FaceBlock:
        """Return the block that holds all of some faces that the view sees, with corners at `pixels` (k, 3, 2)."""
        spots = np.clip(np.nan_to_num(pixels.reshape(-1, 2)), 0, fine.resolution)
        low, high = (side.astype(int) for side in (np.floor(spots.min(axis=0)) - MARGIN,
                                                   np.ceil(spots.max(axis=0)) + MARGIN))
        return cls(fine, faces, own, pixels, low, high - low, np.zeros(2, dtype=int))

    @property
    def shift(self) -> np.ndarray:
        return self.corner - self.low

    def draw(self, paths: LightPaths, seen: bool = False) -> None:
        """Write the light path of each texel whose centre a face covers; the path from the eye if `seen`."""
        faces, width = self.faces, self.fine.resolution[0]
        drawn = draw(self.fine, faces.images, faces.corners[self.own])
        at = np.flatnonzero(drawn.triangle >= 0)
        row, column = np.divmod(at, width)
        own, weights = drawn.triangle[at], drawn.weights[:, at]
        face = self.own[own]
        breathe()
        targets = faces.positions[faces.corners[face]] if seen else faces.targets[face]
        target = np.einsum("kn,nki->ni", weights, targets)
        if seen:
            origin = target - self.fine.directions(target)
        else:
            origin = np.einsum("kn,nki->ni", weights, faces.origins[face])
            normal = np.einsum("kn,nki->ni", weights, faces.normals[face])
            sky = np.flatnonzero(faces.sky[face])
            # the true map: the normal is that between the corners, and of unit length
            target[sky] = world_targets(self.fine, origin[sky], normal[sky])
        breathe()
        across, up = _changes(self.pixels[own], targets)
        if not seen:
            across, up = _before_mirror(across, up, target - origin, normal)
        breathe()
        texel = np.linalg.norm(across, axis=1) + np.linalg.norm(up, axis=1)
        lead = texel / np.maximum(np.linalg.norm(target - origin, axis=1), 1e-30)
        spot = row + self.shift[1], column + self.shift[0]
        paths.used[spot] = True
        paths.target[spot], paths.origin[spot], paths.across[spot], paths.up[spot] = target, origin, across, up
        lead = np.where(faces.displaced[face], FROM_MIRROR, np.clip(lead, NEAREST, FARTHEST))
        paths.lead[spot] = SEEN_LEAD if seen else lead


def _changes(pixels: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how much the targets (n, 3, 3) at corners seen at `pixels` (n, 3, 2) change from pixel to pixel, (n, 3)
    along a row and along a column."""
    (a, b), (c, d) = np.moveaxis(pixels[:, 1:] - pixels[:, :1], 0, 2)
    first, second = targets[:, 1] - targets[:, 0], targets[:, 2] - targets[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (a * d - b * c)
        across = (first * d[:, None] - second * b[:, None]) * inverse[:, None]
        up = (second * a[:, None] - first * c[:, None]) * inverse[:, None]
    # a face seen edge on has none
    longest = np.abs(targets - targets.mean(axis=1, keepdims=True)).max(axis=(1, 2))[:, None]
    return tuple(np.clip(np.nan_to_num(change), -longest, longest) for change in (across, up))


def _before_mirror(across: np.ndarray, up: np.ndarray, path: np.ndarray, normal: np.ndarray
                   ) -> tuple[np.ndarray, np.ndarray]:
    """Return changes (n, 3) so short that the target, with all of its texel, lies on the mirror's side on which the
    light path (n, 3) does: beside the line where a source meets its mirror the change would lead behind it."""
    room = ROOM * np.abs(np.einsum("ni,ni->n", path, normal))
    reach = sum(np.abs(np.einsum("ni,ni->n", change, normal)) for change in (across, up))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(reach > room, room / reach, 1.0)[:, None]
    return across * share, up * share


class PointBlock:
    """A rectangle of texels, one for each point of a reflection of points."""

    def __init__(self, placed: Placed, view: View) -> None:
        self.placed, self.view, self.count = placed, view, len(placed.mesh.vertices)
        width = max(int(np.ceil(np.sqrt(self.count))), 1)
        self.size, self.corner = np.array((width, -(-self.count // width))), np.zeros(2, dtype=int)

    def spots(self, size: np.ndarray) -> np.ndarray:
        """Return the place (n, 2) of each point in a picture of `size` texels, from 0 to 1."""
        return (self._texels() + 0.5) / size

    def draw(self, paths: LightPaths, seen: bool = False) -> None:
        """Write the light path of each point; the path from the eye if `seen`."""
        column, row = self._texels().T
        if seen:
            target = self.placed.positions
            origin = target - self.view.directions(target)
        else:
            target, origin = (vectors(self.placed.mesh, name) for name in ("reflected_position", "mirror_position"))
        paths.used[row, column], paths.target[row, column], paths.origin[row, column] = True, target, origin
        paths.lead[row, column] = POINT_LEAD

    def _texels(self) -> np.ndarray:
        row, column = np.divmod(np.arange(self.count), self.size[0])
        return np.stack((column, row), axis=1) + self.corner


def _pack(blocks: list) -> np.ndarray:
    """Stack blocks in shelves, the highest first; return the size of the whole."""
    width = max((int(block.size[0]) for block in blocks), default=1)
    shelf = used = height = 0
    for block in sorted(blocks, key=lambda block: -block.size[1]):
        if used + block.size[0] > width:
            shelf, used = shelf + height, 0
        if used == 0:
            height = int(block.size[1])
        block.corner = np.array((used, shelf))
        used += int(block.size[0])
    return np.array((width, max(shelf + height, 1)))
