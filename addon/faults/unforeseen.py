"""The one door for errors: one sentence for the user; of an error that nobody foresaw, the rest for the console."""
from __future__ import annotations

import functools
import traceback
from collections.abc import Callable

import bpy
from bpy.app.translations import pgettext_iface

from ...core import ReflectionError
from .told import tell

LONGEST = 200   # characters of an error's own words


def sentence(error: Exception, what: str, unchanged: str = "nothing has changed") -> str:
    """One sentence on an error; where it was not foreseen, its traceback goes to the console.

    Parameters
    ----------
    what : str
        What failed, as the sentence's subject.
    unchanged : str
        What the failure has left as it was.
    """
    if isinstance(error, ReflectionError):
        return str(error)
    if isinstance(error, ReferenceError):
        return "An object was removed while the work went on: start it again."
    if isinstance(error, MemoryError):
        return "The memory does not suffice: raise the tolerance or reflect fewer objects at once."
    traceback.print_exception(error)
    words = " ".join(str(error).split()).rstrip(".")
    if len(words) > LONGEST:
        words = words[:LONGEST] + " ..."
    reason = f"{type(error).__name__}: {words}" if words else type(error).__name__
    return f"{what} failed for a reason that was not foreseen ({reason}): {unchanged}; the console tells more."


def in_one_sentence(execute: Callable) -> Callable:
    """Wrap an operator's `execute` so that any error is reported in one sentence and cancels the operator."""
    # Blender counts the arguments of what it calls
    @functools.wraps(execute)
    def guarded(self, context: bpy.types.Context) -> set:
        try:
            return execute(self, context)
        except Exception as error:
            tell(self, {"ERROR"}, sentence(error, pgettext_iface(self.bl_label)))
            return {"CANCELLED"}
    return guarded
