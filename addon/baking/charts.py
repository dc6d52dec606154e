"""What is kept of the pictures of objects' light, in one picture of all: of each level no more than was baked."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core import ReflectionError, View, breathe
from ..reading import DiffuseScene
from .asked_parts import pixels_shown
from .levels import levels_of
from .texels import arranged, packed

LARGEST = 4096  # texels along a side of all maps together
# texels of all that is kept that no light is too dear for; and for each pixel that results are seen in, where these are
# many: the light on objects is made in the time of the picture's, or a few times that
FEWEST, MOST = 4_300_000, 8.0
SMALL = 24      # texels for each triangle: the smallest take eight, and the box round them up to twice that
# of the texels along a line, where there are too many, from one try to the next at the least, and at the most
LESS, CLOSE = 0.5, 0.98
NEARLY = 1.1    # times as many along a line are too many: they are as many as there is room for


@dataclass(frozen=True)
class Chart:
    """What is kept of a level's picture of one side of a source, from its column and row `low` (2,) on and of a `size`
    (2,), `at` (2,) in the picture of all."""

    number: int
    back: bool
    level: int
    low: np.ndarray
    size: np.ndarray
    at: np.ndarray


def laid_out(levels: dict, charts: list) -> tuple[np.ndarray, np.ndarray]:
    """What `ObjectLight` has as `uv` and `frames`, in texels."""
    uv, frames = [], []
    for chart in charts:
        uv.append(levels[chart.number].whole[chart.level].spots - chart.low + chart.at)
        # interpolation looks at what lies half a texel beside
        frames.append(np.broadcast_to((chart.at + 0.5, chart.at + chart.size - 0.5), (len(uv[-1]), 2, 2)))
    return np.concatenate(uv), np.concatenate(frames)


def charts_of(results: list, view: View, scene: DiffuseScene, parts: list, sides: list,
              density: list) -> tuple[dict, list[Chart]]:
    """The levels by source, and what is kept of each of `sides` in one picture: at a `density` of texels per unit for
    each triangle of each source, whose triangles `parts` are, or nearly as fine as there is room for and is worth it.

    Raises
    ------
    ReflectionError
        Where there are more triangles than texels.
    """
    corners = scene.mesh.positions[scene.mesh.triangles]
    most = max(FEWEST, MOST * pixels_shown(results, view), SMALL * sum(len(parts[number]) for number, _ in sides))
    held, least, scale = None, np.inf, 1.0
    while held is None or least > NEARLY * held[0]:
        breathe()
        scaled = [one * scale for one in density]
        atlases = {number: packed(corners[part], scaled[number]) for number, part in enumerate(parts)}
        levels = levels_of(results, view, scene, parts, scaled, atlases)
        kept = [(number, back, level) for number, back in sides for level in levels[number].kept(back)]
        framed = [levels[number].frame(level, back) for number, back, level in kept]
        sizes = np.array([size for _, size in framed])
        at, side = arranged(sizes)
        share = min(LARGEST / side, math.sqrt(most / sizes.prod(axis=1).sum()))
        if share >= 1.0:
            charts = [Chart(*of, *frame, start) for of, frame, start in zip(kept, framed, at, strict=True)]
            held = scale, levels, charts
            if scale == 1.0:
                break
        elif max(one.max() for one in scaled) * np.ptp(corners) < 1.0:
            raise ReflectionError("The reflected objects have more triangles than a map of their light has room for: "
                                  "choose Light: Picture.")
        else:
            least = scale
        # what has to be fine depends on how fine the finest is, and so what it takes does not go by squares
        scale = scale * max(LESS, CLOSE * share) if held is None else math.sqrt(held[0] * least)
    return held[1:]
