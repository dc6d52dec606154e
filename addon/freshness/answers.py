"""Answers to what is stale and why, asked again only after a change."""
from __future__ import annotations

from collections.abc import Callable

import bpy

from ..faults import work_waits
from . import digests

_known: dict[tuple[str, int], tuple] = {}


def answer(ask: Callable[[bpy.types.Context, bpy.types.Object], str], context: bpy.types.Context,
           obj: bpy.types.Object, key: tuple) -> str:
    """Return what `ask` says about an object.

    It is asked again where Blender has told of a change, or `key` is another. While an operator waits between two steps
    of its work, for which it may have changed the file for a while, the last answer holds.
    """
    name, now = (ask.__module__, obj.session_uid), (digests.tick(), *key)
    known = _known.get(name, (None, ""))
    if known[0] == now or work_waits():
        return known[1]
    _known[name] = now, ask(context, obj)
    return _known[name][1]
