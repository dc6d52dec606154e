"""Unwrap reflections by where the camera sees them: a place in one picture for each face, and the light path of each
texel.

A texel is as large as a share of a pixel. Each source has blocks of texels of its own, so that nothing shines across
the outline of another one. Faces behind one another lie in different blocks too, if each is to keep its light where
what hides it is taken away.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...core import View, breathe, draw, pages_of
from ..reading import vectors
from .further_mirrors import FurtherMirrors
from .light_paths import STEPS, LightPaths
from .lit_faces import Faces, Placed, faces_of
from .texel_blocks import Block, blocks_of, pack
from .world_faces import far_away, world_targets

NEAREST, FARTHEST = 1e-4, 0.25  # bounds of a path's lead
ROOM = 1.4          # distances to the mirror across which a texel may reach, half of it to either side
FROM_MIRROR = 1.0 - 1e-5    # lead of a path that begins at the mirror
FROM_LAST_MIRROR = 1.0      # the same for one that begins beside the last of several mirrors
LEAST_TURN = 0.02   # radians between the samples of a texel, if the light depends on the direction
POINT_LEAD = 1e-3   # the same for points, which lie at vertices
FARTHEST_SPOT = 1e3     # pictures from a picture to the place of a corner in it, which single precision has to tell
SEAM = 2            # pixels that a block shares with another one of its group, up to its border
SEEN_LEAD = 2e-5    # the same for paths from the eye to a reflection, whose layers lie close together


@dataclass(frozen=True)
class Unwrapped:
    """Reflections unwrapped into one picture.

    Attributes
    ----------
    size : (width, height) in texels
    spots : list of (m, 3, 2) float64, from 0 to 1 in the camera's view, for each reflection with faces; (n, 2) for one
        of points
    pages : list of Page, of faces
    points : list of PointBlock
    """

    size: tuple[int, int]
    spots: list
    pages: list
    points: list

    @property
    def of_points(self) -> np.ndarray:
        """True for texels (h, w) of points: those beside one are of other points, so that it cannot be denoised."""
        found = np.zeros(self.size[::-1], dtype=bool)
        for block in self.points:
            column, row = block.texels().T
            found[row, column] = True
        return found

    def paths(self, further: FurtherMirrors | None = None, seen: bool = False) -> LightPaths:
        """Return the light path of each texel; those to the world by `further` mirrors too; the path from the eye to
        the reflection itself if `seen`."""
        paths = LightPaths.empty(self.size[1], self.size[0])
        for part in self.pages + self.points:
            part.draw(paths, further, seen)
        # between blocks there are unused texels: those beside an outline have fewer neighbours
        used = np.pad(paths.used, 1)
        paths.spread[..., 0] = used[1:-1, :-2] & used[1:-1, 2:]
        paths.spread[..., 1] = used[:-2, 1:-1] & used[2:, 1:-1]
        # samples have one origin: close before the mirror, those of a pane would look in all directions
        long, texel = (sum(np.linalg.norm(one, axis=2) for one in parts) for parts in (
            (paths.target - paths.origin,), (paths.across, paths.up)))
        turn = np.maximum(paths.turn, LEAST_TURN)
        paths.spread[...] *= np.minimum(turn * long / np.maximum(texel, 1e-30), 1.0)[..., None]
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
    pages = [Page(fine, joined, own, pixels[own], joined.group[own])
             for own in (np.flatnonzero(page == number) for number in np.unique(page))]
    points = [PointBlock(one, view) for one in placed if not one.has_faces]
    size = pack([block for one in pages for block in one.blocks] + points)
    spots, of_points = np.zeros((len(joined.corners), 3, 2)), [block.spots(size) for block in points]
    for one in pages:
        spots[one.own] = (one.pixels + one.shifts[one.block][:, None]) / size
    # corners beside the camera's view lie beside the picture: the part of their face that is seen would else be bent
    spots = np.clip(np.nan_to_num(spots), -FARTHEST_SPOT, FARTHEST_SPOT)
    with_faces = iter(np.split(spots, np.cumsum([len(one.corners) for one in faces])[:-1]))
    without = iter(of_points)
    return Unwrapped(size, [next(with_faces if one.has_faces else without) for one in placed], pages, points)


class Page:
    """Faces of which none hides another one, in a block for each of their groups.

    Attributes
    ----------
    fine : View, whose pixels are texels
    faces : Faces, and which of them are on the page: `own` (k,)
    pixels : (k, 3, 2) float64, where the view sees their corners
    block : (k,) int64, which of the `blocks` each is in
    """

    def __init__(self, fine: View, faces: Faces, own: np.ndarray, pixels: np.ndarray, group: np.ndarray) -> None:
        self.fine, self.faces, self.own, self.pixels = fine, faces, own, pixels
        self.group = group
        spots = np.clip(np.nan_to_num(pixels), 0, fine.resolution)
        self.block, self.low, self.blocks = blocks_of(group, spots)

    @property
    def shifts(self) -> np.ndarray:
        """(b, 2) int64, from the view's columns and rows to those of the picture, for each block."""
        return np.array([block.corner for block in self.blocks]) - self.low

    def draw(self, paths: LightPaths, further: FurtherMirrors | None, seen: bool) -> None:
        """Write the light path of each texel whose centre a face covers; the path from the eye if `seen`."""
        faces, width = self.faces, self.fine.resolution[0]
        drawn = draw(self.fine, faces.images, faces.corners[self.own])
        at, block = self._texels(drawn.triangle)
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
        left, later = np.ones_like(target), np.zeros(0, dtype=np.int64)
        if further is not None and not seen:
            later, places, ahead, tint = further.follow(self.fine, origin[sky])
            later = sky[later]
            origin[later], target[later], left[later] = places, places + far_away(self.fine) * ahead, tint
            across[later] = up[later] = 0.0
        texel = np.linalg.norm(across, axis=1) + np.linalg.norm(up, axis=1)
        lead = texel / np.maximum(np.linalg.norm(target - origin, axis=1), 1e-30)
        shift = self.shifts[block]
        spot = row + shift[:, 1], column + shift[:, 0]
        paths.used[spot], paths.left[spot], paths.turn[spot] = True, left, faces.turn[face]
        paths.target[spot], paths.origin[spot], paths.across[spot], paths.up[spot] = target, origin, across, up
        lead = np.where(faces.displaced[face], FROM_MIRROR, np.clip(lead, NEAREST, FARTHEST))
        # lamps that only the last mirror shows are met on the way: the material does not add them
        lead[later] = FROM_LAST_MIRROR
        paths.lead[spot] = SEEN_LEAD if seen else lead


    def _texels(self, drawn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the pixels (n,) that faces (h * w,) are seen in, and the block (n,) of each. Where a group has several
        blocks, each also has the pixels beside it, so that light is interpolated and denoised across its border."""
        at = np.flatnonzero(drawn >= 0)
        block = self.block[drawn[at]]
        if len(np.unique(self.group)) == len(self.blocks):
            return at, block
        width, height = self.fine.resolution
        group_of = np.zeros(len(self.blocks), dtype=np.int64)
        group_of[self.block] = self.group
        for _ in range(SEAM):
            row, column = np.divmod(at, width)
            wider = [(at, block)]
            for down, right in STEPS:
                inside = (0 <= row + down) & (row + down < height) & (0 <= column + right) & (column + right < width)
                beside, own = at[inside] + down * width + right, block[inside]
                face = drawn[beside]
                same = (face >= 0) & (self.group[face] == group_of[own]) & (self.block[face] != own)
                wider.append((beside[same], own[same]))
            pairs = np.unique(np.concatenate([own * drawn.size + beside for beside, own in wider]))
            block, at = np.divmod(pairs, drawn.size)
        return at, block


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


class PointBlock(Block):
    """A rectangle of texels, one for each point of a reflection of points."""

    def __init__(self, placed: Placed, view: View) -> None:
        self.placed, self.view, self.count = placed, view, len(placed.mesh.vertices)
        width = max(int(np.ceil(np.sqrt(self.count))), 1)
        super().__init__(np.array((width, -(-self.count // width))), np.zeros(2, dtype=np.int64))

    def spots(self, size: np.ndarray) -> np.ndarray:
        """Return the place (n, 2) of each point in a picture of `size` texels, from 0 to 1."""
        return (self.texels() + 0.5) / size

    def draw(self, paths: LightPaths, _: FurtherMirrors | None, seen: bool) -> None:
        """Write the light path of each point; the path from the eye if `seen`."""
        column, row = self.texels().T
        if seen:
            target = self.placed.positions
            origin = target - self.view.directions(target)
        else:
            target, origin = (vectors(self.placed.mesh, name) for name in ("reflected_position", "mirror_position"))
        paths.used[row, column], paths.target[row, column], paths.origin[row, column] = True, target, origin
        paths.lead[row, column] = SEEN_LEAD if seen else POINT_LEAD

    def texels(self) -> np.ndarray:
        """Return the column and row (n, 2) of each point in the picture."""
        row, column = np.divmod(np.arange(self.count), self.size[0])
        return np.stack((column, row), axis=1) + self.corner
