"""Blender's own messages, kept off the standard output of a command that has something of its own to say."""
from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Any


def quietly(work: Callable[[], Any], into: int = 2) -> Any:
    """Run `work` while the process' standard output goes to the file descriptor `into`; returns what it returns."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(into, 1)
    try:
        return work()
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
