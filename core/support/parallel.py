"""Work on several cores: NumPy lets other threads run while it works on large arrays."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from typing import TypeVar

from .stepping import breathe

Part = TypeVar("Part")
Result = TypeVar("Result")
WAIT = 0.05     # seconds between the turns of the caller that waits for the work
_threads = [os.cpu_count() or 1]


def use_threads(count: int) -> None:
    """Let work be done by so many threads from now on, at least one. Results do not depend on their number.

    Examples
    --------
    >>> from core import use_threads
    >>> use_threads(2)
    """
    _threads[0] = max(int(count), 1)


def in_parallel(work: Callable[[Part], Result], parts: Sequence[Part]) -> list[Result]:
    """Return what `work` makes of each of the parts, in their order.

    Examples
    --------
    >>> from core.support import in_parallel
    >>> in_parallel(sum, [(1, 2), (3, 4)])
    [3, 7]
    """
    if _threads[0] == 1 or len(parts) < 2:
        found = []
        for part in parts:
            breathe()
            found.append(work(part))
        return found
    pool = ThreadPoolExecutor(min(_threads[0], len(parts)))
    try:
        asked = [pool.submit(work, part) for part in parts]
        left = set(asked)
        while left:
            _, left = wait(left, WAIT, FIRST_COMPLETED)
            breathe()
        return [one.result() for one in asked]
    finally:
        pool.shutdown(cancel_futures=True)
