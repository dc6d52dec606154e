"""Work in steps: a generator yields (fraction, stage) before each step, and may be closed there."""
from __future__ import annotations

from collections.abc import Callable, Generator
from typing import TypeVar

from .between_events import steps_taken
from .interrupts import interrupt_held

Result = TypeVar("Result")
Steps = Generator[tuple[float, str], None, Result]


class Undivided(str):
    """The stage of a step that cannot be divided, however long it takes: whoever shows stages shows it before."""


class Beside(str):
    """The stage of work that goes on beside: there is nothing to do but to look, now and then, whether it has ended."""


def part(steps: Steps, start: float, share: float, name: str = "") -> Steps:
    """The progress of a part of the work as progress of the whole; returns what `steps` returns.

    Parameters
    ----------
    start, share : float
        Where the part begins in the whole, and how much of it it is.
    name : str
        Stands before each stage, and for one without a name.
    """
    try:
        while True:
            fraction, stage = next(steps)
            yield start + share * min(max(fraction, 0.0), 1.0), type(stage)(": ".join(filter(None, (name, stage))))
    except StopIteration as stop:
        return stop.value
    finally:
        # where the whole is closed, the part cleans up before it
        steps.close()


def finished(steps: Generator, tell: Callable | None = None) -> object:
    """Run steps to their end, telling what each of them yields; returns what they return. Ctrl-C ends them after a
    step."""
    with interrupt_held() as heard, steps_taken(apart=False):
        try:
            while not heard:
                told = next(steps)
                if tell is not None:
                    tell(told)
        except StopIteration as stop:
            return stop.value
        finally:
            # what interrupts between two steps must not leave their work lying about
            steps.close()
