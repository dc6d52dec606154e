"""A bake in bands of its picture: Blender answers to nothing while it bakes, and would keep a window waiting."""
from __future__ import annotations

import math

LONG = 0.3     # seconds that a band takes, where what goes before its first sample lets it
BEFORE = 2.0   # times what goes before it that a band takes at least: in bands all takes about twice as long at most
FEW = 5000     # samples of an object's first band, and twice as many of its second: together they tell what goes
SECOND = 2.0   # before the first sample, and how long each takes
FASTER = 2.0   # times the samples of the bands before, at most: others may be slower to shade
LEAST = 1e-3   # seconds that samples take
MOST = 300     # bands of a picture, however long they take


class Bands:
    """How much is baked at a time, which the bands before tell."""

    def __init__(self) -> None:
        self._samples = float(FEW)
        self._shortest = math.inf
        # number of bands, and sums over them of samples and seconds, and of what their straight line is fitted by
        self._sums = [0.0] * 5

    def rows(self, samples_of_a_row: int, height: int) -> int:
        """How many rows the next band has of a picture of `height` rows."""
        return max(int(self._samples / samples_of_a_row), math.ceil(height / MOST))

    def took(self, seconds: float, samples: int, between: float = 0.0) -> None:
        """What the last band took, and the window before it: one that takes long to draw waits no longer for bands."""
        self._shortest = min(self._shortest, seconds)
        for number, value in enumerate((1.0, samples, seconds, samples * samples, samples * seconds)):
            self._sums[number] += value
        if self._sums[0] == 1.0:
            self._samples = max(SECOND * samples, FEW)
            return
        before = self._before()
        each = max(seconds - before, LEAST) / samples
        asked = max(LONG, BEFORE * before, between) - before
        self._samples = min(asked / each, FASTER * max(samples, self._samples))

    def _before(self) -> float:
        """What goes before the first sample of a band: where the line through all so far begins."""
        count, samples, seconds, squares, products = self._sums
        spread = count * squares - samples * samples
        if spread <= 0.0:
            return 0.0
        slope = max((count * products - samples * seconds) / spread, 0.0)
        return min(max((seconds - slope * samples) / count, 0.0), self._shortest)
