"""A folder of results that changes all at once: written beside, and put in place when all of it is whole."""
from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import count

from ...core import ReflectionError
from ..faults import AllOrNothing
from .scratch import scratch_folder, why_unwritable


def check_folder(folder: str) -> None:
    """Check that files can be written into the absolute `folder`, or that it can be made, as far as possible in
    advance.

    Raises
    ------
    ReflectionError
        If they cannot.
    """
    above = folder
    while not os.path.lexists(above):
        above = os.path.dirname(above)
    why = why_unwritable(above)
    if why and above == folder:
        raise ReflectionError(f"The folder '{folder}' cannot be written ({why}): choose another one.")
    if why:
        raise ReflectionError(f"The folder '{folder}' cannot be made ({why}): choose another one.")


@contextmanager
def staged(folder: str) -> Iterator[str]:
    """Yield a temporary folder to write into. At the end its files move to `folder`, and it is deleted.

    `folder` is made where it does not exist. After an error nothing in it has changed; one that was made is gone.

    Raises
    ------
    ReflectionError
        Where `folder` cannot be made or written, or runs full.
    """
    with AllOrNothing() as made:
        _make(folder, made)
        with scratch_folder(folder) as scratch:
            try:
                yield scratch
                _place(scratch, folder)
            except OSError as error:
                if error.filename is not None and not str(error.filename).startswith(scratch):
                    raise
                raise ReflectionError(f"The folder '{folder}' cannot be written ({error.strerror}): make room in it, "
                                      "or choose another one.") from error


def keep(path: str, spare: str) -> None:
    """Give the file at `path` a second name, so that it can be replaced. Move it where there are no hard links."""
    try:
        os.link(path, spare, follow_symlinks=False)
    except (OSError, NotImplementedError):
        os.replace(path, spare)


def replaceable(path: str) -> bool:
    """Return True if `path` is free, a file or a link, but not a folder, a device or a pipe."""
    return os.path.isfile(path) or os.path.islink(path) or not os.path.lexists(path)


def _make(folder: str, made: AllOrNothing) -> None:
    """Make a folder and those above it that are missing; another process may do so at the same time."""
    for path in _missing(folder):
        try:
            os.mkdir(path)
        except OSError as error:
            if os.path.isdir(path):
                continue
            raise ReflectionError(f"The folder '{folder}' cannot be made ({error.strerror}): choose another one."
                                  ) from error
        made.undo(_forget, os.rmdir, path)


def _missing(folder: str) -> list[str]:
    """Return the folders that must be made for a path, from the top."""
    above = os.path.dirname(folder)
    if os.path.isdir(folder) or above == folder:
        return []
    return [*_missing(above), folder]


def _forget(remove: Callable[[str], None], path: str) -> None:
    """Remove an item that was made, if possible. A folder into which others have put files stays."""
    with suppress(OSError):
        remove(path)


def _place(scratch: str, folder: str) -> None:
    """Move all files of `scratch` to the same places in `folder`, or none; a link there is replaced, never followed."""
    numbers = count()
    with scratch_folder(folder) as earlier, AllOrNothing() as whole:
        for place, inner, names in os.walk(scratch):
            within = os.path.join(folder, os.path.relpath(place, scratch))
            for make, name in [(True, name) for name in inner] + [(False, name) for name in names]:
                target = os.path.normpath(os.path.join(within, name))
                spare = os.path.join(earlier, str(next(numbers)))
                try:
                    if make:
                        _make_folder(target, spare, whole)
                    else:
                        _replace(os.path.join(place, name), target, spare, whole)
                except OSError as error:
                    raise ReflectionError(f"'{target}' cannot be written ({error.strerror}): rename or remove it, or "
                                          "choose another folder.") from error


def _make_folder(target: str, spare: str, whole: AllOrNothing) -> None:
    """Make a folder at `target` if there is none. A link there moves to `spare` until `whole` is done."""
    if os.path.islink(target):
        os.replace(target, spare)
        whole.undo(os.replace, spare, target)
    elif os.path.isdir(target):
        return
    try:
        os.mkdir(target)
    except FileExistsError:
        if os.path.isdir(target):  # another process has just made it
            return
        raise
    whole.undo(_forget, os.rmdir, target)


def _replace(new: str, target: str, spare: str, whole: AllOrNothing) -> None:
    """Replace `target` by `new`. The old file or link moves to `spare` until `whole` is done."""
    if not replaceable(target):
        raise FileExistsError(errno.EEXIST, "it is a folder or a device", target)
    # another process may remove it at any moment
    with suppress(FileNotFoundError):
        keep(target, spare)
    if os.path.lexists(spare):
        whole.undo(os.replace, spare, target)
    else:
        whole.undo(_forget, os.unlink, target)
    os.replace(new, target)
