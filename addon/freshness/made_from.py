"""The record of what a result was made from, and what has become of that."""
from __future__ import annotations

import json
from typing import NamedTuple

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..frames import plays
from ..reading import read_view
from . import digests

SAME = 1e-6  # of a matrix's largest number: what differs by less has been there and back
LONGEST = 20_000  # characters of a record; its own are below a thousand
# the record of a result that was left before it was exact
COARSE = json.dumps({"coarse": True})

_told: dict[int, tuple] = {}


class Origin(NamedTuple):
    """What a result is made from: the numbers of the view, and digests of the mirror and of the sources."""

    view: tuple[float, ...]
    mirror: str
    sources: str


def origin_of(depsgraph: bpy.types.Depsgraph, view: View, mirror: bpy.types.Object, sources: list) -> Origin:
    """What a result would be made from now."""
    return Origin(view_numbers(view), digests.digest_of(depsgraph, [mirror]), digests.digest_of(depsgraph, sources))


def record_of(origin: Origin) -> str:
    """The text that a result keeps."""
    return json.dumps({**origin._asdict(), "view": [float(f"{number:.8g}") for number in origin.view]})


def same_view(one: tuple, other: tuple) -> bool:
    """Whether two views show the same, but for rounding."""
    if len(one) != len(other) or one[32:] != other[32:]:
        return False
    return all(np.allclose(a, b, rtol=0.0, atol=SAME * max(np.abs(b).max(), 1e-300))
               for a, b in zip(np.reshape(one[:32], (2, 16)), np.reshape(other[:32], (2, 16))))


def why_stale(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """What has changed since a result was made, in a few words; empty where nothing has, or where nobody can tell.

    As cheap as a look: what it finds is kept until something changes again.
    """
    text = result.reflection_mesh.made_from
    if not text or plays(result):
        return ""
    key = digests.tick(), text
    if _told.get(result.session_uid, (None,))[0] != key:
        made = _read(text)
        _told[result.session_uid] = key, "" if made is None else _changed(context, result, made)
    return _told[result.session_uid][1]


def _changed(context: bpy.types.Context, result: bpy.types.Object, made: Origin | str) -> str:
    """What is no longer as it was `made` from."""
    record = result.reflection_mesh
    sources = [source.object for source in record.sources]
    if isinstance(made, str):
        return "Live was stopped before it was exact"
    if record.mirror is None or None in sources:
        return "an object was removed"
    try:
        now = origin_of(context.evaluated_depsgraph_get(), read_view(context), record.mirror, sources)
    except ReflectionError:
        return ""
    if not same_view(made.view, now.view):
        return "the camera or the picture's size has changed"
    if made.mirror != now.mirror:
        return "the mirror has changed"
    return "a reflected object has changed" if made.sources != now.sources else ""


def _read(text: str) -> Origin | str | None:
    """What a record tells; None where it is none of this extension's."""
    if not text or len(text) > LONGEST:
        return None
    try:
        known = json.loads(text)
        if known.get("coarse") is True:
            return text
        return Origin(tuple(float(number) for number in known["view"]), str(known["mirror"]), str(known["sources"]))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def view_numbers(view: View) -> tuple[float, ...]:
    """What tells one view from another."""
    return (*view.camera_to_world.ravel().tolist(), *view.projection.ravel().tolist(), *map(float, view.resolution))
