"""Files that verbs open."""
from __future__ import annotations

import os

import bpy

from ... import core


def open_file(path: str) -> None:
    """Open a file, whose scripts stay off."""
    try:
        bpy.ops.wm.open_mainfile(filepath=os.path.abspath(path), use_scripts=False)
    except RuntimeError as error:
        reason = " ".join(str(error).removeprefix("Error: ").split()).rstrip(".")
        raise core.ReflectionError(f"'{path}' cannot be opened ({reason}): name a .blend file.") from error
