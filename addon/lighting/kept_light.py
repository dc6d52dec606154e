"""Light that stays right while the camera moves: texels that an earlier picture of light has are copied from it.

Each texel knows the source point that it shows. Where the earlier picture shows that point is found by Newton's method
in that picture, from points near it, texel by texel.
"""
from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np

from ...core import breathe
from ...core.geometry import unit
from ..reading.materials import all_materials_of, steady_angle
from .known_texels import Texels, known_texels
from .light_paths import LightPaths, grown

GRID = 4            # texels between those that are looked for among all points; the others are looked for from these
STEPS = 5           # of Newton's method
FARTHEST = 64.0     # texels in one step
FOUND = 0.75        # texels from the middle of one
OFF = 0.5           # texels that a point may lie before or behind the surface that the earlier picture shows there
COARSEST, FINEST = 1.5, 0.5  # bounds of the length of an earlier texel, in new ones
SAME_SIDE = 0.9     # cosine between the normals
OLDEST = 3          # times that light is copied: each time it is interpolated between texels
SEAM = 2            # texels across which new light goes over into kept light


class KeptLight(NamedTuple):
    """Light of some texels of a new picture (h, w), and how often it has been copied; 0 where it is not known."""

    light: np.ndarray
    age: np.ndarray

    @classmethod
    def found(cls, images: list[bpy.types.Image], paths: LightPaths) -> KeptLight:
        """Copy the light of texels from earlier pictures in which the same source points are found.

        Parameters
        ----------
        images : list of bpy.types.Image
            Earlier pictures of light; the first one that shows a point is used. The caller must make sure that nothing
            but the view has changed since they were rendered. Pictures whose light paths are no longer in memory are
            ignored.
        paths : LightPaths
            Light paths of the new picture.

        Returns
        -------
        KeptLight
            Light and age are 0 for texels whose point is not found, was seen in a too different direction or size, or
            whose light has been copied too often. Both are 0 everywhere if nothing is found.
        """
        kept = cls(np.zeros_like(paths.target), np.zeros(paths.used.shape, dtype=np.uint8))
        for image in images:
            known = known_texels(image)
            if known is not None and known.paths is not None:
                kept._add(known, _pixels(image), paths)
        return kept

    def _add(self, known: Texels, pixels: np.ndarray, paths: LightPaths) -> None:
        """Copy what an earlier picture with these `pixels` knows of what is not known yet."""
        row, column = np.nonzero(paths.used & (paths.turn > 0.0) & (self.age == 0))
        spots, good = _spots(known, paths, row, column)
        row, column, spots = row[good], column[good], spots[good]
        at = np.rint(spots).astype(np.int64)
        age = known.age[at[:, 1], at[:, 0]] + 1
        young = age <= OLDEST
        self.age[row[young], column[young]] = age[young]
        self.light[row[young], column[young]] = _interpolated(pixels, spots[young])

    def missing(self, paths: LightPaths) -> LightPaths:
        """Return the paths whose light is to be rendered: of texels that are not known, and of some beside them."""
        new, = grown(paths.used & (self.age == 0), [], SEAM)
        return replace(paths, used=paths.used & new)

    def completed(self, light: np.ndarray, paths: LightPaths) -> np.ndarray:
        """Return rendered light of the missing paths with the light that is kept."""
        if not self.age.any():
            return light
        share = np.zeros(paths.used.shape, dtype=np.float32)
        new = paths.used & (self.age == 0)
        for ring in range(SEAM):
            share[grown(new, [], ring)[0]] += 1.0 / SEAM
        return share[..., None] * light + (1.0 - share[..., None]) * self.light


def steady_turn(source: bpy.types.Object | None) -> float:
    """Return the angle in radians by which a source may be seen from elsewhere and look the same."""
    return 0.0 if source is None else min(map(steady_angle, all_materials_of(source)), default=np.pi)


def _pixels(image: bpy.types.Image) -> np.ndarray:
    """Return the colours (h, w, 3) of an image."""
    width, height = image.size
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, -1)[..., :3]


def _spots(known: Texels, paths: LightPaths, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where in an earlier picture the points of texels lie, (n, 2) columns and rows, and where that is right."""
    places = np.full((*paths.used.shape, 2), np.nan, dtype=np.float32)
    first = np.flatnonzero((row % GRID == 0) & (column % GRID == 0))
    near = [known.tree.find(point)[1] for point in paths.target[row[first], column[first]].tolist()]
    places[row[first], column[first]] = known.spots[near] * known.size - 0.5
    good = np.zeros(len(row), dtype=bool)
    good[first] = True
    left = first
    for y, x in ((0, 0), (0, 0), (0, GRID), (GRID, 0), (GRID, GRID)):
        # the first time these are the texels of the grid itself
        from_row = np.minimum(row[left] // GRID * GRID + y, len(places) - 1)
        from_column = np.minimum(column[left] // GRID * GRID + x, places.shape[1] - 1)
        start = places[from_row, from_column]
        tried = left[np.isfinite(start[:, 0])]
        spots, good[tried] = _newton(known.paths, paths, row[tried], column[tried], start[np.isfinite(start[:, 0])])
        places[row[tried], column[tried]] = np.where(good[tried, None], spots, np.nan)
        left = np.flatnonzero(~good)
        breathe()
    return places[row, column], good


def _newton(old: LightPaths, new: LightPaths, row: np.ndarray, column: np.ndarray, spots: np.ndarray
            ) -> tuple[np.ndarray, np.ndarray]:
    """Return `_spots` of texels, from places (n, 2) near them."""
    point, limit = new.target[row, column], np.array(old.used.shape[::-1]) - 1
    for _ in range(STEPS):
        at = np.clip(np.rint(spots), 0, limit).astype(np.int64)
        there = at[:, 1], at[:, 0]
        changes = np.stack((old.across[there], old.up[there]), axis=1)
        inverse = _pseudo_inverse(changes)
        off = point - old.target[there]
        step = np.clip(np.einsum("ni,nij->nj", off, inverse), -FARTHEST, FARTHEST)
        spots = at + step
    # how many earlier texels one of the new ones is long and high
    own = np.stack((new.across[row, column], new.up[row, column]), axis=1)
    lengths = np.linalg.norm(own @ inverse, axis=2)
    texel = np.linalg.norm(own, axis=2).max(axis=1)
    beside = np.linalg.norm(off - np.einsum("nj,nji->ni", step, changes), axis=1)
    ahead, before = _ahead(new, row, column), _ahead(old, *there)
    normals = _facing(own, ahead), _facing(changes, before)
    turn = np.arccos(np.clip(np.einsum("ni,ni->n", ahead, before), -1.0, 1.0))
    return spots, (old.used[there] & (np.abs(step) <= FOUND).all(axis=1) & (beside <= OFF * texel)
                   & (lengths >= 1.0 / COARSEST).all(axis=1) & (lengths <= 1.0 / FINEST).all(axis=1)
                   & (np.einsum("ni,ni->n", *normals) >= SAME_SIDE) & (turn <= new.turn[row, column]))


def _pseudo_inverse(changes: np.ndarray) -> np.ndarray:
    """Return the matrices (n, 3, 2) that tell from a way in space the columns and rows, by `changes` (n, 2, 3)."""
    square = changes @ changes.transpose(0, 2, 1)
    (a, b), (_, d) = np.moveaxis(square, 0, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = np.stack((d, -b, -b, a), axis=1).reshape(-1, 2, 2) / (a * d - b * b)[:, None, None]
        return np.nan_to_num(changes.transpose(0, 2, 1) @ inverse, posinf=0.0, neginf=0.0)


def _ahead(paths: LightPaths, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Return the unit directions (n, 3), in world space, of the light paths of texels at `row` (n,) and `column` (n,).

    They point from `paths.origin`, on the mirror or at the eye, to `paths.target`, the source point.
    """
    return unit((paths.target[row, column] - paths.origin[row, column]).T).T


def _facing(changes: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """Return the unit normals (n, 3) of the surface, on the side that is looked at."""
    normal = np.cross(changes[:, 0], changes[:, 1])
    return -np.sign(np.einsum("ni,ni->n", normal, ahead))[:, None] * unit(normal.T).T


def _interpolated(pixels: np.ndarray, spots: np.ndarray) -> np.ndarray:
    """Return the colours (n, 3) at columns and rows `spots` (n, 2), linear between texels."""
    height, width = pixels.shape[:2]
    low = np.floor(spots).astype(np.int64)
    share = (spots - low).astype(np.float32)
    found = np.zeros((len(spots), 3), dtype=np.float32)
    for y in (0, 1):
        for x in (0, 1):
            weight = np.abs(1 - x - share[:, 0]) * np.abs(1 - y - share[:, 1])
            texel = np.clip(low[:, 1] + y, 0, height - 1), np.clip(low[:, 0] + x, 0, width - 1)
            found += weight[:, None] * pixels[texel]
    return found
