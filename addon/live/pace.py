"""How coarse updates on the way are to be, by what the last ones took."""
from __future__ import annotations

from dataclasses import dataclass

TARGET = 0.1  # seconds that an update on the way may take
COARSEST = 16.0  # pixels, or the file's own tolerance: beyond it nothing gets faster
SLACK = 0.3  # of the target: an update that takes no more may be finer


@dataclass
class Pace:
    """The tolerance of updates on the way.

    Attributes
    ----------
    tolerance : float
        In pixels.
    """

    tolerance: float = 4.0

    def took(self, seconds: float) -> None:
        """Learn from an update of the present tolerance; never by more than four times at once."""
        if seconds > TARGET or seconds < SLACK * TARGET:
            self.tolerance *= min(max(seconds / TARGET, 0.5), 4.0)
        self.tolerance = min(max(self.tolerance, 0.01), COARSEST)

    def coarse(self, exact: float) -> float:
        """The tolerance of updates on the way, where that of the file is `exact`."""
        return max(self.tolerance, exact)
