"""Several steps that all happen or none."""
from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack


class AllOrNothing:
    """A block whose steps are undone in reverse order if it ends with any error.

    Before each step, the block registers its reversal with `undo`. With `after` it registers work for the time when all
    steps have succeeded, such as deleting replaced data, which cannot be undone.
    """

    def __init__(self) -> None:
        self._back, self._last = ExitStack(), ExitStack()

    def undo(self, action: Callable, *arguments) -> None:
        """Call `action` with `arguments` if the block fails."""
        self._back.callback(action, *arguments)

    def after(self, action: Callable, *arguments) -> None:
        """Call `action` with `arguments` once the block has succeeded."""
        self._last.callback(action, *arguments)

    def __enter__(self) -> AllOrNothing:
        return self

    def __exit__(self, kind, error, trace) -> None:
        (self._last if kind is None else self._back).close()
