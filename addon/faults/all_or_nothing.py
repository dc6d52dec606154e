"""Several steps that all happen or none."""
from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack


class AllOrNothing:
    """A block whose steps are taken back, the last one first, where it ends with an error of any kind.

    Before each step the block says how it is taken back, by `undo`, and what is left to do once all steps have
    succeeded, by `after`: what cannot be taken back, such as deleting what was replaced.
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
