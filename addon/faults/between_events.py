"""Whether steps are taken between the events of a window: then Blender's own jobs go on meanwhile."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

_are = False


def between_events() -> bool:
    """Whether the step that is being taken is one of many between which Blender comes to its events: a render may go
    on in a thread of its own, and who waits for it need not keep the window waiting."""
    return _are


@contextmanager
def steps_taken(apart: bool) -> Iterator[None]:
    """Within, steps are taken between events, or all at once."""
    global _are
    before, _are = _are, apart
    try:
        yield
    finally:
        _are = before
