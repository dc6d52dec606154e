"""A bake in bands of its picture: Blender answers to nothing while it bakes, and would keep a window waiting."""
from __future__ import annotations

import math

import numpy as np

from ...writing import UV_MAP

WAITED = 0.5   # seconds that nobody minds to wait
LONG = 0.25    # seconds that a band takes, where what goes before its first sample lets it
BEFORE = 2.0   # times what goes before it that a band takes at least: in bands all takes about twice as long at most
FEW = 5000     # samples of an object's first band, and twice as many of its second: together they tell what goes
SECOND = 2.0   # before the first sample, and how long each takes
SOME = 0.2     # of what bands of others have, an object's first band: it may be slower to shade
FASTER = 2.0   # times the samples of the bands before, at most: others may be slower to shade
LEAST = 1e-3   # seconds that samples take
MOST = 300     # bands of a picture, however long they take
EMPTY = 0.04   # of what a sample takes, a texel that nothing is baked into


def samples_in_rows(objects: list, size: tuple[int, int], of_a_texel: int) -> np.ndarray:
    """How many samples the rows (height,) take of a picture of a `size`, width and height, into which `objects` of
    triangles are baked: about so many as their texels have, and a little for those that nothing is baked into."""
    width, height = size
    covered = np.zeros(height + 1)
    for obj in objects:
        uv = np.empty((len(obj.data.loops), 2), dtype=np.float32)
        obj.data.uv_layers[UV_MAP].uv.foreach_get("vector", uv.reshape(-1))
        corners = uv.reshape(-1, 3, 2) * np.array(size)
        (x, y), (other_x, other_y) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        first = np.clip(np.floor(corners[..., 1].min(axis=1)), 0, height - 1).astype(int)
        end = np.clip(np.ceil(corners[..., 1].max(axis=1)), first + 1, height).astype(int)
        of_each = 0.5 * np.abs(x * other_y - y * other_x) / (end - first)
        covered += np.bincount(first, of_each, height + 1) - np.bincount(end, of_each, height + 1)
    return of_a_texel * np.maximum(np.cumsum(covered)[:height], 0.0) + EMPTY * width


class Bands:
    """How much is baked at a time, which the bands before tell."""

    def __init__(self, of_others: float = 0.0) -> None:
        """They begin with a part of the samples that bands `of_others` have by now."""
        self.samples = max(SOME * of_others, FEW)
        self._shortest = math.inf
        self._asked = 0.0
        # number of bands, and sums over them of samples and seconds, and of what their straight line is fitted by
        self._sums = [0.0] * 6

    def rows(self, samples: np.ndarray, row: int) -> int:
        """How many rows the next band has, from a `row` on, of a picture with so many `samples` in its rows (h,)."""
        reached = np.cumsum(samples[row:])
        return max(int(np.searchsorted(reached, max(self.samples, samples.sum() / MOST), side="right")), 1)

    def took(self, seconds: float, samples: float, between: float = 0.0) -> None:
        """What the last band took, and the window before it: one that takes long to draw waits no longer for bands."""
        self._shortest = min(self._shortest, seconds)
        told = (1.0, samples, seconds, samples * samples, samples * seconds, seconds * seconds)
        self._sums = [so_far + value for so_far, value in zip(self._sums, told, strict=True)]
        if self._sums[0] == 1.0:
            self.samples = max(SECOND * samples, FEW)
            return
        before = self._before()
        each = max(seconds - before, LEAST) / samples
        self._asked = max(LONG, BEFORE * before, between)
        self.samples = min((self._asked - before) / each, FASTER * max(samples, self.samples))

    @property
    def are_long(self) -> bool:
        """Whether the next band keeps a window waiting, whatever it has."""
        return self._asked > WAITED

    def _before(self) -> float:
        """What goes before the first sample of a band: where the line through all so far begins, as flat as it may well
        be: where times vary, ever smaller bands would tell ever less of it."""
        count, samples, seconds, squares, products, of_seconds = self._sums
        spread = squares - samples * samples / count
        if spread <= 0.0:
            return 0.0
        slope = (products - samples * seconds / count) / spread
        left = of_seconds - seconds * seconds / count - slope * slope * spread
        doubt = math.sqrt(max(left, 0.0) / (max(count - 2.0, 1.0) * spread))
        flat = max(slope - doubt, 0.0)
        return min(max((seconds - flat * samples) / count, 0.0), self._shortest)
