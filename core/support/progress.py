"""Progress: how far the work is, how long its stages took, and how much of each part the scene needed."""
from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter

from .stepping import tell


@dataclass
class Progress:
    """Seconds by stage, and how much of each part the scene needed, over all bounces.

    `start` and `share` tell which part of the whole work the stages that come next are.
    """

    seconds: dict[str, float] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    last: float = field(default_factory=perf_counter)
    start: float = 0.0
    share: float = 1.0

    def next(self, done: float, stage: str) -> None:
        """Tell the caller that a stage comes next, before which so much of the present part of the work is `done`."""
        tell(self.start + self.share * done, stage)

    def done(self, stage: str, **counts: int) -> None:
        now = perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self.last
        self.last = now
        for name, count in counts.items():
            self.counts[name] = self.counts.get(name, 0) + int(count)
