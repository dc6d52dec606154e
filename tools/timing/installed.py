"""Measured on the extension as it is installed, scene after scene."""
from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from tools import extension_zip
from tools.quietly import quietly


def measured_installed(sizes: Iterable[int], measure: Callable[[int], list]) -> list[list]:
    """What `measure` tells of each size while the extension is installed from its zip, into a place of its own."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as scratch:
        extension_zip.use_throw_away_preferences(Path(scratch) / "preferences")
        quietly(lambda: extension_zip.install(extension_zip.build(Path(scratch))))
        for size in sizes:
            rows.append(quietly(lambda size=size: measure(size)))
            print(f"{size} vertices: done", file=sys.stderr, flush=True)
        quietly(extension_zip.switch_off)
    return rows
