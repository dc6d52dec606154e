"""How finely each part of each object is baked: as finely as results show it, in pictures from coarse to fine."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import View, breathe
from ...core.geometry import doubled_areas, edge_lengths
from ..reading import DiffuseScene
from .asked_parts import asked_densities, sides_before_mirrors
from .fineness import fineness
from .rims import spread, with_its_rim
from .texels import UNTOUCHED, Atlas, Division, divided, enlarged, packed, parts_along

COARSER = 4     # times than the finest the coarsest picture of an object is that is worth more than one
COARSEST = 1024  # texels along a side that the coarsest has at the most
WIDE = 32.0     # texels across triangles from which on what lies side by side in a picture does in the scene too
NEARLY_ALL = 0.7  # of an object's parts: what all coarser pictures together cost less than
ALMOST_ALL = 0.9  # of an object's surface, whose triangles are so wide where that holds for its picture
LARGE = 256     # texels along a side of a picture from which on more than one are made: each bake has its price
BORDER = 1      # texels around what is baked
MOST_SHOWN = 0.5  # of a texel, from which on it tells what is shown of it
OUTSIDE = -1.0  # of a picture: where what is not baked has its place


@dataclass(frozen=True)
class ObjectLevels:
    """An object's pictures, coarse to fine.

    Attributes
    ----------
    wide : bool
        Whether what lies side by side in them does in the scene too.
    division : Division
        The parts of its triangles.
    atlases : list of Atlas
        Of these parts, level by level.
    needed : list of dict of (bool or None) to (p,) bool
        Which parts are baked, level by level, by whether their backs are asked for; None: either side.
    whole : list of Atlas
        Of the triangles, level by level.
    """

    wide: bool
    division: Division
    atlases: list[Atlas]
    needed: list[dict]
    whole: list[Atlas]

    def kept(self, back: bool) -> list[int]:
        """The levels of which something is kept of a side: one at least."""
        return [level for level, needed in enumerate(self.needed) if not level or needed[back].any()]

    def nowhere(self) -> np.ndarray:
        """Where the parts lie in a picture in which none is baked, (p, 3, 2)."""
        return np.full((len(self.division.owner), 3, 2), OUTSIDE, dtype=np.float32)

    def places(self, level: int, back: bool | None) -> np.ndarray:
        """Where the parts that are baked lie in a level's window, (p, 3, 2), those that are not, outside."""
        low, size = self.window(level, back)
        own = (self.atlases[level].spots - low) / np.maximum(size, 1)
        return np.where(self.needed[level][back][:, None, None], own, OUTSIDE).astype(np.float32)

    def window(self, level: int, back: bool | None) -> tuple[np.ndarray, np.ndarray]:
        """The lowest column and row of the part of a level's picture that is baked, and its width and height: what is
        not in it is not denoised."""
        return self._around(level, self.needed[level][back])

    def frame(self, level: int, back: bool | None) -> tuple[np.ndarray, np.ndarray]:
        """The same of what is kept of the picture: of small ones the whole."""
        if self.whole[-1].size < LARGE:
            return np.zeros(2, np.int64), np.full(2, self.whole[level].size)
        low, size = self.window(level, back)
        return low, np.maximum(size, 1)

    def _around(self, level: int, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        spots = self.atlases[level].spots[parts]
        if not len(spots):
            return np.zeros(2, np.int64), np.zeros(2, np.int64)
        low = np.maximum(np.floor(spots.min(axis=(0, 1))).astype(np.int64) - BORDER, 0)
        high = np.minimum(np.ceil(spots.max(axis=(0, 1))).astype(np.int64) + BORDER, self.atlases[level].size)
        return low, high - low

    def _within(self, level: int, back: bool | None) -> np.ndarray:
        """Which parts (p,) reach into what is kept of a level's picture."""
        low, size = self.frame(level, back)
        spots = self.atlases[level].spots
        return ((spots.max(axis=1) >= low) & (spots.min(axis=1) <= low + size)).all(axis=1)

    def in_frame(self, level: int, back: bool | None, parts: np.ndarray) -> np.ndarray:
        """Corners of parts (p,) in what is kept of a level's picture, (n, 3, 2), in texels."""
        return self.atlases[level].spots[parts] - self.frame(level, back)[0]

    def baked_parts(self, level: int, back: bool | None, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the parts that are baked, (b, 3, 3) in space, where those of the triangles are (m, 3, 3), and
        `in_frame`."""
        needed = self.needed[level][back]
        return self.division.values(corners)[needed], self.in_frame(level, back, needed)

    def texels(self, level: int, back: bool | None) -> float:
        """About how many texels of a level are baked."""
        corners = self.atlases[level].spots[self.needed[level][back]]
        return max(0.5 * float(np.abs(doubled_areas(corners)).sum()), 1.0)

    def picture(self, back: bool | None, baked: np.ndarray, coarser: list[np.ndarray],
                colours: np.ndarray | None = None, shown: np.ndarray | None = None) -> np.ndarray:
        """What is kept of the picture of the level after all `coarser` ones, (height, width, 4), from these and from
        what was baked of its window, light and `colours` that have a pattern, with all texels known; where less than
        all of them is `shown` (height, width), by what is."""
        level = len(coarser)
        low, (width, height) = self.frame(level, back)
        column, row = self.window(level, back)[0] - low
        found = np.full((height, width, 4), UNTOUCHED, dtype=np.float32)
        own = slice(row, row + len(baked)), slice(column, column + baked.shape[1])
        found[own] = with_its_rim(baked, colours) if self.wide else baked
        breathe()
        if shown is not None:
            found = _as_shown(found, shown)
            breathe()
        known = found[..., 3] != UNTOUCHED
        left = self._within(level, back) & ~self.needed[level][back]
        for before in reversed(range(level)):
            rest = left & self.needed[before][back]
            left &= ~rest
            enlarged(coarser[before], found, known, self.in_frame(before, back, rest), self.in_frame(level, back, rest))
        return spread(found, known)


def fine_where_seen(results: list, view: View, scene: DiffuseScene, parts: list, density: np.ndarray) -> list:
    """Texels per unit of length of each triangle (n,) of each source, whose triangles `parts` are: as its pixels per
    unit, `density` (k,), ask for, but of those made of small triangles that want a large picture, as many as results
    show, and no less than the coarsest picture of others has: a concave mirror shows little of a head, and that
    large."""
    finer = fineness(scene)
    density = finer * density
    densities = [np.full(len(part), one) for part, one in zip(parts, density, strict=True)]
    corners = scene.mesh.positions[scene.mesh.triangles]
    maps = {number: packed(corners[part], densities[number]) for number, part in enumerate(parts)}
    breathe()
    single = {number: divided(np.ones(len(parts[number]), dtype=np.int64)) for number, atlas in maps.items()
              if atlas.size >= LARGE and not is_wide(atlas)}
    for number, asked in asked_densities(results, view, scene, parts, single).items():
        densities[number] = np.clip(finer[number] * asked, density[number] / COARSER, density[number])
    return densities


def levels_of(results: list, view: View, scene: DiffuseScene, parts: list, density: list, atlases: dict) -> dict:
    """The levels by source, whose triangles `parts` are, at a `density` of texels per unit for each of these, (n,), and
    as `atlases` have them at that."""
    corners = scene.mesh.positions[scene.mesh.triangles]
    wide = {number: is_wide(atlas) for number, atlas in atlases.items()}
    large = {number: wide[number] and atlas.size >= LARGE for number, atlas in atlases.items()}
    divisions = {number: divided(parts_along(atlas.spots, WIDE if large[number] else np.inf))
                 for number, atlas in atlases.items()}
    breathe()
    seen = sides_before_mirrors(results, scene)
    breathe()
    asked = asked_densities(results, view, scene, parts, {number: one for number, one in divisions.items()
                                                          if large[number]})
    made, finer = {}, fineness(scene)
    for number, part in enumerate(parts):
        breathe()
        division = divisions[number]
        # where nearly all is to be fine, coarser pictures would only cost
        most = density[number][division.owner]
        in_steps = large[number] and (finer[number] * asked[number] > 0.5 * most).mean() < NEARLY_ALL
        levels = _times(atlases[number].size) if in_steps else [1]
        maps = [atlases[number] if times == 1 else packed(corners[part], density[number] / times)
                for times in levels]
        front, back = seen[:, part[division.owner]]
        needed = [{False: front, True: back, None: front | back}]
        for times in levels[1:]:
            # what the level before shows finely enough is left to it
            fine = finer[number] * asked[number] > most / (2.0 * times)
            needed.append({side: once & fine for side, once in needed[0].items()})
        made[number] = ObjectLevels(wide[number], division, [Atlas(one.size, division.values(one.uv)) for one in maps],
                                    needed, maps)
    return made


def _times(size: int) -> list[int]:
    """How many times coarser than the finest, of a `size` in texels, each picture is of an object that has several."""
    times = [1]
    while times[0] < COARSER or size > COARSEST * times[0]:
        times.insert(0, 2 * times[0])
    return times


def is_wide(atlas: Atlas) -> bool:
    """Whether the triangles of a picture are so large in it that denoising mixes nothing that lies apart."""
    area, across = np.abs(doubled_areas(atlas.spots)), edge_lengths(atlas.spots).min(axis=1)
    return float(area[across >= WIDE].sum()) >= ALMOST_ALL * float(area.sum())


def _as_shown(picture: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """A picture (height, width, 4) whose texels tell of what is `shown` of them (height, width) alone: what is hidden
    is dark, and those of which it is most are as those beside."""
    known = picture[..., 3] != UNTOUCHED
    whole = known & (shown == 1.0)
    part = known & ~whole & (shown >= MOST_SHOWN)
    # where a denoiser has brought light to the dark, there may be too much in what is left
    inner = spread(picture, whole)
    breathe()
    told = np.minimum(picture / np.maximum(shown, MOST_SHOWN)[..., None], inner)
    breathe()
    told[known & ~whole & ~part] = UNTOUCHED
    return np.where(whole[..., None] | ~known[..., None], picture, told)
