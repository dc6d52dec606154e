"""Global state of operators that work in steps: whether one is working, whether it is inside a step, and whether
Blender handles events between its steps.
"""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

_between_events = False
_works, _steps = [False], [0]  # True if an operator of the window is working; number of nested steps in progress


def between_events() -> bool:
    """Return True if the current step is one of many between which Blender handles events. Then a render may run in a
    thread of its own, and waiting for it need not block the window.
    """
    return _between_events


def work_waits() -> bool:
    """Return True while an operator is at work in a window, between two of its steps."""
    return _works[0] and not _steps[0]


def works(goes_on: bool) -> None:
    """Note that an operator has begun its work in a window, or has ended it."""
    _works[0] = goes_on


@contextmanager
def steps_taken(apart: bool) -> Iterator[None]:
    """Take steps inside the block between events (`apart`), or all at once."""
    global _between_events
    before, _between_events = _between_events, apart
    _steps[0] += 1
    try:
        yield
    finally:
        _between_events = before
        _steps[0] -= 1
