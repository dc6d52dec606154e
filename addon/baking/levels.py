"""How finely each part of each object is baked: as finely as results show it, in pictures from coarse to fine."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import View, breathe
from ..reading import DiffuseScene
from .asked_parts import asked_densities, sides_before_mirrors
from .rims import spread, with_its_rim
from .texels import UNTOUCHED, Atlas, Division, divided, enlarged, packed, parts_along

COARSER = (4, 2, 1)  # times, of the pictures in which an object is baked that is worth it
WIDE = 32.0     # texels across triangles from which on what lies side by side in a picture does in the scene too
NEARLY_ALL = 0.7  # of an object's parts: what all coarser pictures together cost less than
ALMOST_ALL = 0.9  # of an object's surface, whose triangles are so wide where that holds for its picture
FINER = 1.5     # texels a pixel along a line: interpolation and the picture's filter blur them
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
    """

    wide: bool
    division: Division
    atlases: list[Atlas]
    needed: list[dict]

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
        spots = self.atlases[level].spots[self.needed[level][back]]
        if not len(spots):
            return np.zeros(2, np.int64), np.zeros(2, np.int64)
        low = np.maximum(np.floor(spots.min(axis=(0, 1))).astype(np.int64) - BORDER, 0)
        high = np.minimum(np.ceil(spots.max(axis=(0, 1))).astype(np.int64) + BORDER, self.atlases[level].size)
        return low, high - low

    def baked_parts(self, level: int, back: bool | None, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the parts that are baked, (b, 3, 3) in space, where those of the triangles are (m, 3, 3), and
        (b, 3, 2) in a level's picture, in texels."""
        needed = self.needed[level][back]
        return self.division.values(corners)[needed], self.atlases[level].spots[needed]

    def texels(self, level: int, back: bool | None) -> float:
        """About how many texels of a level are baked."""
        return float(self.atlases[level].size**2 * max(self.needed[level][back].mean(), 1e-3))

    def picture(self, level: int, back: bool | None, baked: np.ndarray, coarser: np.ndarray | None,
                colours: np.ndarray | None = None, shown: np.ndarray | None = None) -> np.ndarray:
        """A level's picture from what was baked of its window, light and `colours` that have a pattern, and the picture
        before, with all texels known; where less than all of them is `shown` (side, side), by what is."""
        (column, row), side = self.window(level, back)[0], self.atlases[level].size
        found = np.full((side, side, 4), UNTOUCHED, dtype=np.float32)
        own = slice(row, row + len(baked)), slice(column, column + baked.shape[1])
        found[own] = with_its_rim(baked, colours) if self.wide else baked
        breathe()
        if shown is not None:
            found = _as_shown(found, shown)
            breathe()
        known = found[..., 3] != UNTOUCHED
        if coarser is not None:
            rest = ~self.needed[level][back]
            before, own = self.atlases[level - 1], self.atlases[level]
            enlarged(coarser, found, known, before.spots[rest], own.spots[rest])
        return spread(found, known)


def fine_where_seen(results: list, view: View, scene: DiffuseScene, parts: list, density: np.ndarray) -> list:
    """Texels per unit of length of each triangle (n,) of each source, whose triangles `parts` are: its `density` (k,),
    but of those made of small triangles that want a large picture, as many as results show, and no less than the
    coarsest picture of others has: a concave mirror shows little of a head, and that large."""
    densities = [np.full(len(part), one) for part, one in zip(parts, density, strict=True)]
    corners = scene.mesh.positions[scene.mesh.triangles]
    maps = {number: packed(corners[part], densities[number]) for number, part in enumerate(parts)}
    breathe()
    single = {number: divided(np.ones(len(parts[number]), dtype=np.int64)) for number, atlas in maps.items()
              if atlas.size >= LARGE and not is_wide(atlas)}
    for number, asked in asked_densities(results, view, scene, parts, single).items():
        densities[number] = np.clip(FINER * asked, density[number] / COARSER[0], density[number])
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
    made = {}
    for number, part in enumerate(parts):
        breathe()
        division = divisions[number]
        # where nearly all is to be fine, coarser pictures would only cost
        most = density[number][division.owner]
        in_steps = large[number] and (FINER * asked[number] > 0.5 * most).mean() < NEARLY_ALL
        levels = COARSER if in_steps else COARSER[-1:]
        maps = [atlases[number] if times == 1 else packed(corners[part], density[number] / times)
                for times in levels]
        front, back = seen[:, part[division.owner]]
        needed = [{False: front, True: back, None: front | back}]
        for times in levels[1:]:
            # what the level before shows finely enough is left to it
            fine = FINER * asked[number] > most / (2.0 * times)
            needed.append({side: once & fine for side, once in needed[0].items()})
        made[number] = ObjectLevels(wide[number], division, [Atlas(one.size, division.values(one.uv)) for one in maps],
                                    needed)
    return made


def is_wide(atlas: Atlas) -> bool:
    """Whether the triangles of a picture are so large in it that denoising mixes nothing that lies apart."""
    corners = atlas.spots
    sides = corners[:, (1, 2, 0)] - corners
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    across = np.linalg.norm(sides, axis=2).min(axis=1)
    return float(area[across >= WIDE].sum()) >= ALMOST_ALL * float(area.sum())


def _as_shown(picture: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """A picture (side, side, 4) whose texels tell of what is `shown` of them (side, side) alone: what is hidden is
    dark, and those of which it is most are as those beside."""
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
