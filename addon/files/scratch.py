"""Temporary folders and files, named after their process, so that the next one clears what a killed one has left."""
from __future__ import annotations

import os
import platform
import re
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ...core import ReflectionError

# other machines may use the same folder, and what runs there is not seen from here
MACHINE = re.sub(r"[^A-Za-z0-9-]", "-", platform.node())[:40] or "machine"
NAME = re.compile(rf"reflection_mesh_{MACHINE}_(\d{{1,9}})_[a-z0-9_]{{8}}(\.blend@?)?")


def own_prefix() -> str:
    """Return the prefix of this process's names; eight letters or digits follow."""
    return f"reflection_mesh_{MACHINE}_{os.getpid()}_"


def temporary_blend(folder: str) -> str:
    """Return an unused path for a .blend file in `folder`."""
    return os.path.join(folder, f"{own_prefix()}{secrets.token_hex(4)}.blend")


@contextmanager
def scratch_folder(where: str | None = None) -> Iterator[str]:
    """Make a folder in `where`, or in the system's directory for temporary files, and delete it in the end.

    Raises
    ------
    ReflectionError
        Where it cannot be made.
    """
    folder = scratch_place() if where is None else where
    clear_leftovers(folder)
    try:
        path = tempfile.mkdtemp(prefix=own_prefix(), dir=folder)
    except OSError as error:
        if where is None:
            raise scratch_is_full() from error
        raise ReflectionError(f"The folder '{folder}' cannot be written ({error.strerror}): choose another one."
                              ) from error
    try:
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)


def why_unwritable(folder: str) -> str:
    """Return the system's reason why a folder is not writable; "" if it is."""
    try:
        os.rmdir(tempfile.mkdtemp(prefix=own_prefix(), dir=folder))
    except OSError as error:
        return error.strerror or str(error)
    return ""


def scratch_place() -> str:
    """Return the system's directory for temporary files."""
    try:
        return tempfile.gettempdir()
    except OSError as error:
        raise ReflectionError("No folder for temporary files can be written: make room, or name another one with "
                              "TMPDIR.") from error


def scratch_is_full() -> ReflectionError:
    """Return the error for a temporary file that was not written completely."""
    return ReflectionError(f"The scratch folder '{scratch_place()}' is full or cannot be written: make room in it, or "
                           "name another one with TMPDIR.")


def has_room(folder: str, size: int) -> bool:
    """Return True if `size` bytes can be written into a folder."""
    path = os.path.join(folder, "room")
    try:
        with open(path, "wb") as file:
            for _ in range(size >> 20):
                file.write(bytes(1 << 20))
            file.write(bytes(size % (1 << 20)))
        return True
    except OSError:
        return False
    finally:
        with suppress(OSError):
            os.unlink(path)


def clear_leftovers(folder: str) -> None:
    """Remove what processes that have ended left in `folder`: only what bears our name, and belongs to this user."""
    if os.name != "posix":
        return  # asking for a process ends it on Windows
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            known = NAME.fullmatch(entry.name)
            if known and not _runs(int(known[1])):
                with suppress(OSError):
                    _remove(entry)


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True     # another user's
    return True


def _remove(entry: os.DirEntry) -> None:
    """Remove a folder or a file of this user; links stay, wherever they lead."""
    if entry.is_symlink() or entry.stat(follow_symlinks=False).st_uid != os.geteuid():
        return
    if entry.is_dir(follow_symlinks=False):
        shutil.rmtree(entry.path, ignore_errors=True)
    elif entry.is_file(follow_symlinks=False):
        os.unlink(entry.path)
