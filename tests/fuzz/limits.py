"""Work within bounds: what takes too long is stopped, and what takes too much memory gets none."""
from __future__ import annotations

import contextlib
import resource
import signal
from collections.abc import Iterator

AGAIN = 5.0  # seconds after which it is said once more, in case that something on the way swallowed it


class TooLong(BaseException):
    """More processor time than allowed; no `except Exception` on the way stops it."""


def _too_long(*_) -> None:
    raise TooLong


@contextlib.contextmanager
def at_most(seconds: float, gigabytes: float | None = None) -> Iterator[None]:
    """Raise TooLong after `seconds` of processor time, and MemoryError where more than `gigabytes` are asked for.

    The clock is looked at between two steps of Python: a single long call of NumPy is stopped at its end.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    if gigabytes is not None:
        wanted = _address_space() + int(gigabytes * 1e9)
        resource.setrlimit(resource.RLIMIT_AS, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard))
    before = signal.signal(signal.SIGPROF, _too_long)
    signal.setitimer(signal.ITIMER_PROF, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def _address_space() -> int:
    """Bytes of address space that this process has."""
    with open("/proc/self/statm") as numbers:
        return int(numbers.read().split()[0]) * resource.getpagesize()


def peak_gigabytes() -> float:
    """The most memory that this process ever held."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9
