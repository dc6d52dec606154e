"""The generation of new results in time slices."""
from __future__ import annotations

import time
from dataclasses import dataclass, field

import bpy

from ...core import ReflectionError, Settings
from ..faults import Steps
from ..operators.generate import Outcome, generation
from ..operators.write_results import Manners
from .watched import Record, Watched

BUDGET = 0.05   # seconds of work between two looks at what has changed


@dataclass
class Work:
    """The generation of all groups, one after another.

    Attributes
    ----------
    record : Record
        The inputs.
    settings : dict of int to Settings
        Settings of each mirror, by its `session_uid`.
    exact : bool
        True if the settings are the file's.
    on_the_way : bool
        True if it was started during movement. Then it is finished despite further movement, to be visible at all.
    seconds : float
        Duration so far.
    outcomes : list of Outcome
    told : str
        Message on why some results are missing.
    """

    record: Record
    settings: dict[int, Settings]
    exact: bool
    on_the_way: bool
    _waiting: list[Steps[Outcome]]
    seconds: float = 0.0
    outcomes: list[Outcome] = field(default_factory=list)
    told: str = ""

    @classmethod
    def of(cls, context: bpy.types.Context, current: Watched, settings: dict[int, Settings],
           on_the_way: bool) -> Work:
        def of_mirror(mirror: bpy.types.Object) -> Settings:
            return settings[mirror.session_uid]
        return cls(current.record, settings, settings == current.record.settings, on_the_way,
                   [_reading_at_once(generation(context, group, of_mirror, manners=Manners(preview_unlit=True),
                                                view=current.view)) for group in current.chosen])

    def go_on(self) -> bool:
        """Work for one time slice. Return True when everything is done."""
        started = time.perf_counter()
        begun = False
        while self._waiting and not (begun and time.perf_counter() - started >= BUDGET):
            begun = True
            try:
                next(self._waiting[0])
            except StopIteration as stop:
                self.outcomes.append(stop.value)
                del self._waiting[0]
            except ReflectionError as error:
                # an error of one mirror does not stop the others
                self.told = str(error)
                del self._waiting[0]
        self.seconds += time.perf_counter() - started
        return not self._waiting

    def close(self) -> None:
        """Stop without leaving anything behind."""
        for steps in self._waiting:
            steps.close()
        self._waiting = []


def _reading_at_once(steps: Steps[Outcome]) -> Steps[Outcome]:
    """Yield the steps of a generation. The first step reads all reflected objects, so that nothing moves in between."""
    next(steps)
    return (yield from steps)
