"""Work in two threads: NumPy lets go of the interpreter in its loops, so shares of large arrays go side by side."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from .stepping import breathe

WORKERS = 2  # more gain nothing: between its loops NumPy holds the interpreter
Share = TypeVar("Share")
Result = TypeVar("Result")


def side_by_side(work: Callable[[Share], Result], parts: Iterable[Share]) -> list[Result]:
    """What `work` makes of each of the parts, in their order, as if one came after another."""
    parts = list(parts)
    if len(parts) < 2 * WORKERS:
        return [work(part) for part in parts]
    pool = ThreadPoolExecutor(WORKERS)
    try:
        found = []
        for result in pool.map(work, parts):
            breathe()
            found.append(result)
        return found
    finally:
        pool.shutdown(cancel_futures=True)
