"""Saves the open file, or a copy of it, so that no broken file is left: Blender says nothing of a full disk."""
from __future__ import annotations

import os
from contextlib import suppress

import bpy

from ...core import ReflectionError
from .scratch import clear_leftovers, temporary_blend, why_unwritable
from .staged import keep, replaceable
from .whole import is_whole


def check_place(path: str) -> None:
    """Check that a file can be saved at the absolute `path`, as far as possible in advance.

    Raises
    ------
    ReflectionError
        If it cannot.
    """
    folder = os.path.dirname(path)
    if os.path.isdir(path):
        raise ReflectionError(f"'{path}' is a folder: name a file in it.")
    if not replaceable(path):
        raise ReflectionError(f"'{path}' is a device and no file: name another one.")
    if not os.path.isdir(folder):
        raise ReflectionError(f"'{path}' cannot be saved, because there is no folder '{folder}': make it first.")
    if os.path.exists(path) and not os.access(path, os.W_OK):
        raise ReflectionError(f"'{path}' is protected from writing: name another file.")
    if why := why_unwritable(folder):
        raise ReflectionError(f"'{path}' cannot be written ({why}): name another file.")


def save_blend(path: str) -> None:
    """Save what is open at the absolute `path`: written beside it, read back, and renamed.

    What stood there becomes the first of as many backups (.blend1 ...) as the user's preferences ask for.

    Raises
    ------
    ReflectionError
        Where the file cannot be written whole; what stood there is as it was.
    """
    check_place(path)
    folder = os.path.dirname(path)
    clear_leftovers(folder)
    temporary = temporary_blend(folder)
    try:
        # Blender does not tell why it could not write
        with open(temporary, "xb"):
            pass
        os.unlink(temporary)
        if not _written(temporary):
            raise ReflectionError(f"'{path}' cannot be written whole, as on a full disk: make room there, or name "
                                  "another file; nothing has been saved.")
        _put(temporary, path)
    except OSError as error:
        raise ReflectionError(f"'{path}' cannot be written ({error.strerror}): name another file.") from error
    finally:
        for leftover in (temporary, f"{temporary}@"):
            with suppress(OSError):
                os.unlink(leftover)


def _written(path: str) -> bool:
    """Save a copy at `path`; in the open file's own folder its relative paths stay as they are."""
    try:
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    except RuntimeError:
        return False
    return is_whole(path)


def _put(temporary: str, path: str) -> None:
    """Move the backups on by one, as Blender does, and put the new file in place."""
    backups = [f"{path}{number}" for number in range(1, bpy.context.preferences.filepaths.save_version + 1)]
    for newer, older in reversed(list(zip(backups, backups[1:], strict=False))):
        if os.path.lexists(newer):
            os.replace(newer, older)
    if backups and os.path.lexists(path):
        if os.path.lexists(backups[0]):
            os.unlink(backups[0])
        keep(path, backups[0])
    try:
        os.replace(temporary, path)
    except OSError:
        if backups and not os.path.lexists(path):
            os.replace(backups[0], path)
        raise
