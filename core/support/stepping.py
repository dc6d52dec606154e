"""Long work in steps: whoever started it may draw, or stop it, wherever it has come to.

The work runs on a stack of its own, a thread that never runs beside the one that waits for it: each hands over to the
other and waits in its turn. So any function may let the caller breathe, however deep in the work it is, without being a
generator itself; outside of such work that does nothing.
"""
from __future__ import annotations

import threading
from collections.abc import Callable, Generator
from time import perf_counter
from typing import Generic, TypeVar

INTERVAL = 0.1  # seconds of work after which the next breath hands over
PATIENCE = 2.0  # seconds that an interrupted caller waits for the work to notice
Result = TypeVar("Result")
_here = threading.local()


class _Stopped(BaseException):
    """Unwinds work that nobody waits for any more."""


def breathe() -> None:
    """Let the caller of the work have its turn, if it has waited long enough; outside of work in steps nothing happens.

    Examples
    --------
    >>> from core import breathe, in_steps
    >>> def work():
    ...     for _ in range(1000):
    ...         breathe()
    >>> for _ in in_steps(work):
    ...     pass  # draw, or break to stop the work
    """
    work = getattr(_here, "work", None)
    if work is not None and (work.stopped or perf_counter() - work.resumed > INTERVAL):
        work.hand_over()


def portions(count: int, size: int) -> Generator[slice, None, None]:
    """Yield consecutive slices of up to `size` entries that cover `count` entries; call `breathe` before each."""
    for start in range(0, count, size):
        breathe()
        yield slice(start, min(start + size, count))


def tell(share: float, stage: str) -> None:
    """Tell the caller of the work the `share` of it that is done, 0 to 1, and the `stage` that comes next."""
    work = getattr(_here, "work", None)
    if work is not None:
        work.told = share, stage
        work.hand_over()


def in_steps(work: Callable[[], Result]) -> Generator[tuple[float, str], None, Result]:
    """Run `work` in steps as a generator, and return its result.

    It yields the last message of `tell`, (share, stage), at every stage and several times a second in long ones.
    Closing the generator, or an error in the caller, stops the work at its next call of `breathe`.

    Examples
    --------
    >>> from core import in_steps
    >>> def tell():
    ...     found = yield from in_steps(lambda: 6 * 7)  # `reflect`, or a tree's `build`
    ...     print(found)
    >>> for share, stage in tell():
    ...     pass  # draw, or break to stop the work
    42
    """
    running = _Work(work)
    try:
        while running.go_on():
            yield running.told
        # yield once more after a long last step, so that the caller's next action is not a part of it
        if perf_counter() - running.resumed > INTERVAL:
            yield running.told
    finally:
        running.stop()
    if running.error is not None:
        raise running.error
    return running.result


class _Work(Generic[Result]):
    """Work on a thread of its own, which takes turns with the caller."""

    result: Result  # set when the work has ended without an error

    def __init__(self, work: Callable[[], Result]) -> None:
        self.told, self.resumed, self.stopped, self.ended = (0.0, ""), 0.0, False, False
        self.error: BaseException | None = None
        self._work = work
        self._mine, self._callers = threading.Semaphore(0), threading.Semaphore(0)
        self._thread = threading.Thread(target=self._run, name="reflection", daemon=True)

    def go_on(self) -> bool:
        """Give the work its turn and wait for ours; return True if the work has not ended."""
        if self._thread.ident is None:
            self._thread.start()
        self._mine.release()
        self._callers.acquire()
        return not self.ended

    def hand_over(self) -> None:
        """Called by the work: give the caller its turn and wait for the next."""
        if not self.stopped:
            self._callers.release()
            self._mine.acquire()
        if self.stopped:
            raise _Stopped
        self.resumed = perf_counter()

    def stop(self) -> None:
        """End the work without a result."""
        if self.ended or self._thread.ident is None:
            return
        self.stopped = True
        self._mine.release()
        self._thread.join(PATIENCE)

    def _run(self) -> None:
        self._mine.acquire()
        _here.work, self.resumed = self, perf_counter()
        try:
            self.result = self._work()
        except _Stopped:
            pass
        except BaseException as error:  # whatever it is, it belongs to the caller
            self.error = error
        self.ended = True
        self._callers.release()
