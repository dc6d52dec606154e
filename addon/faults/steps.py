"""Work in steps: a generator yields (fraction, stage) before each step, and may be closed there."""
from __future__ import annotations

from collections.abc import Callable, Generator
from typing import TypeVar

from .between_events import steps_taken
from .interrupts import interrupt_held

Result = TypeVar("Result")
Steps = Generator[tuple[float, str], None, Result]


class Undivided(str):
    """Stage of a step that cannot be divided, however long it takes. It is displayed before the step starts."""


class Beside(str):
    """Stage of background work. The caller only polls it."""


def part(steps: Steps, start: float, share: float, name: str = "") -> Steps:
    """Yield the progress of a part of the work as progress of the whole. Return the result of `steps`.

    Parameters
    ----------
    start, share : float
        Start of the part in the whole, and its share, both from 0 to 1.
    name : str
        Prefix of each stage; replaces an empty stage.
    """
    try:
        while True:
            fraction, stage = next(steps)
            yield start + share * min(max(fraction, 0.0), 1.0), type(stage)(": ".join(filter(None, (name, stage))))
    except StopIteration as stop:
        return stop.value
    finally:
        # let the part clean up before the whole when that is closed
        steps.close()


def finished(steps: Generator, tell: Callable | None = None) -> object:
    """Run steps to their end and call `tell` with each yielded value. Return their result. Ctrl-C ends them after a
    step.
    """
    with interrupt_held() as heard, steps_taken(apart=False):
        try:
            while not heard:
                told = next(steps)
                if tell is not None:
                    tell(told)
        except StopIteration as stop:
            return stop.value
        finally:
            # clean up after an interrupt between two steps
            steps.close()
