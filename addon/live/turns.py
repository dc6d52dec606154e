"""Work on arrays alone for Live: a turn of it at each look, so that Blender draws between them."""
from __future__ import annotations

import time
from collections.abc import Callable
from typing import Generic, TypeVar

from ...core import in_steps

Result = TypeVar("Result")


class InTurns(Generic[Result]):
    """Work that hands over several times a second.

    Attributes
    ----------
    result : object
        Of the work, once it is done.
    turns : int
    seconds : float
        That these took.
    """

    result: Result

    def __init__(self, work: Callable[[], Result]) -> None:
        self.turns, self.seconds, self._steps = 0, 0.0, in_steps(work)

    def go_on(self) -> bool:
        """Work until it hands over; whether it is done."""
        started = time.perf_counter()
        try:
            next(self._steps)
        except StopIteration as stop:
            self.result = stop.value
            return True
        finally:
            self.turns += 1
            self.seconds += time.perf_counter() - started
        return False

    def close(self) -> None:
        """Stop without a result."""
        self._steps.close()
