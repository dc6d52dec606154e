"""The result of a baseline: the point seen at each pixel, the time by stage, and counts of the work."""
from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from .drawn_mesh import DrawnMesh

NOTHING = -1  # the reflected ray meets nothing, or the pixel shows no mirror
ITSELF = -2  # the reflected ray meets the mirror itself


@dataclass(frozen=True)
class RivalPicture:
    """A reflection as a picture; rows run from below, and what is shown is shown at the pixels' centres.

    Attributes
    ----------
    triangle : (height, width) int64
        Triangle of the diffuse scene, `NOTHING` or `ITSELF`.
    position : (height, width, 3) float64
        The diffuse point shown, in world space and scene units; zero where there is none.
    seconds : dict
        Time by stage. What the eye sees of the mirror is given to all rivals alike and not in it.
    counts : dict
        Work in the units of the talk's cost model: `intersections` (tests of a ray against a triangle or a billboard),
        `traversals` (of a tree, by a ray, a cone or a point), `projections` (of a diffuse vertex) and `rays`; and
        `nodes`, tree nodes tested, which the model does not know. Plain integers.
    mesh : DrawnMesh or None
        What was drawn, where a method makes geometry: it can be looked at anywhere, not at pixels' centres alone.
    """

    triangle: np.ndarray
    position: np.ndarray
    seconds: dict = field(default_factory=dict)
    counts: dict = field(default_factory=dict)
    mesh: DrawnMesh | None = None


class Work:
    """Counts and seconds while they grow."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.counts = dict.fromkeys(("intersections", "traversals", "projections", "rays", "nodes"), 0)
        self._last = perf_counter()

    def count(self, **counts: int) -> None:
        for name, number in counts.items():
            self.counts[name] = self.counts.get(name, 0) + int(number)

    def done(self, stage: str) -> None:
        """Book the time since the last call on `stage`."""
        now = perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now

    def picture(self, resolution: tuple[int, int], pixel: np.ndarray, triangle: np.ndarray,
                position: np.ndarray, mesh: DrawnMesh | None = None) -> RivalPicture:
        """The picture whose pixels `pixel` (n,), along the rows, show `triangle` (n,) at `position` (3, n)."""
        width, height = resolution
        shown = np.full(width * height, NOTHING)
        points = np.zeros((width * height, 3))
        shown[pixel] = triangle
        met = triangle >= 0
        points[pixel[met]] = position[:, met].T
        self.done("picture")
        return RivalPicture(shown.reshape(height, width), points.reshape(height, width, 3), self.seconds, self.counts,
                            mesh)
