"""Processor time of tests: tests without a mark that take too much of it are listed after each run."""
from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

try:
    import resource
except ImportError:  # on Windows, where processor time of child processes is not counted
    resource = None

# what a test without one of these marks may take, in seconds of processor time
ALLOWED = ("thorough", "slow", "feature")
QUICK = 2.0
TOO_SLOW = pytest.StashKey[list]()


def processor_time() -> float:
    """Return the seconds of processor time that this process and its finished children have taken."""
    if resource is None:
        return time.process_time()
    used = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def pytest_configure(config: pytest.Config) -> None:
    config.stash[TOO_SLOW] = []


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    before = processor_time()
    done = yield
    taken = processor_time() - before
    if taken > QUICK and not any(item.get_closest_marker(name) for name in ALLOWED):
        item.config.stash[TOO_SLOW].append((taken, item.nodeid))
    return done


def pytest_terminal_summary(terminalreporter) -> None:
    found = terminalreporter.config.stash[TOO_SLOW]
    if found:
        terminalreporter.section(f"more than {QUICK:g} processor seconds: mark them as thorough or make them cheaper")
    for taken, name in sorted(found, reverse=True):
        terminalreporter.line(f"{taken:6.1f} s  {name}")
