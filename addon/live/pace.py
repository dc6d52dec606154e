"""Choose the tolerance of intermediate updates from the duration of the last ones."""
from __future__ import annotations

from dataclasses import dataclass

TARGET = 0.1  # seconds that an intermediate update may take
COARSEST = 16.0  # pixels, or the file's own tolerance: beyond it nothing gets faster
SLACK = 0.3  # relative to the target; after a faster update the tolerance may be finer


@dataclass
class Pace:
    """The tolerance of intermediate updates.

    Attributes
    ----------
    tolerance : float
        In pixels.
    """

    tolerance: float = 4.0

    def took(self, seconds: float) -> None:
        """Adjust the tolerance after an update that took `seconds`, at most by a factor of four."""
        if seconds > TARGET or seconds < SLACK * TARGET:
            self.tolerance *= min(max(seconds / TARGET, 0.5), 4.0)
        self.tolerance = min(max(self.tolerance, 0.01), COARSEST)

    def coarse(self, exact: float) -> float:
        """Return the tolerance of intermediate updates, where that of the file is `exact`."""
        return max(self.tolerance, exact)
