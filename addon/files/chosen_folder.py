"""The folder that a user has named for results."""
from __future__ import annotations

import os

import bpy

from ...core import ReflectionError


def chosen_folder(path: str) -> str:
    """Return the absolute path of a folder. "//" at its beginning stands for the open file's folder.

    Raises
    ------
    ReflectionError
        If no folder is named, or the open file has none.
    """
    if path.startswith("//") and not bpy.data.filepath:
        raise ReflectionError("The file has not been saved: save it, or choose an absolute folder.")
    if not path:
        raise ReflectionError("No folder is named: choose one for the results.")
    return os.path.abspath(bpy.path.abspath(path))
