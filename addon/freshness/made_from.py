"""The record of what a result was made from, and what has become of that."""
from __future__ import annotations

import json
from typing import NamedTuple

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..frames import plays
from ..lighting import shows_preview
from ..reading import is_gone, lines_drawn, looked_through, lost_mirror, mirrors_of, read_view
from ..settings import SETTINGS, Wanted
from . import digests
from .answers import answer
from .materials import colours_of, materials_of

SAME = 1e-6  # of a matrix's largest number: what differs by less has been there and back
SIZE_DIFFERS = "the picture's size has changed"
LONGEST = 20_000  # characters of a record; its own are below a thousand
# the record of a result that was left before it was exact
COARSE = json.dumps({"coarse": True})


class Origin(NamedTuple):
    """What a result is made from: the numbers of the view, digests of the mirror, of the sources, of which materials
    all of these show and of what the materials are made of (None where an earlier version did not tell), whether lines
    are drawn, and whether the camera may look through a source that it does not see (or None)."""

    view: tuple[float, ...]
    mirror: str
    sources: str
    materials: str | None
    colours: str | None
    lines: bool
    through: bool | None


def origin_of(depsgraph: bpy.types.Depsgraph, view: View, mirrors: list, sources: list) -> Origin:
    """Return what a result of `mirrors`, one or the parts of one, would be made from now."""
    return Origin(view_numbers(view), digests.digest_of(depsgraph, mirrors),
                  digests.digest_of_shown(depsgraph, sources),
                  materials_of([*mirrors, *sources]), colours_of([*mirrors, *sources]), lines_drawn(depsgraph.scene),
                  looked_through(depsgraph, mirrors, sources))


def record_of(origin: Origin, settings: dict) -> str:
    """The text that a result keeps; `settings` are those that its file held for it."""
    return json.dumps({**origin._asdict(), "view": [float(f"{number:.8g}") for number in origin.view],
                       "settings": settings})


def settings_of(scene: bpy.types.Scene, mirror: bpy.types.Object) -> dict:
    """The settings that a scene holds for a mirror, and that its reflection depends on."""
    wanted = Wanted(scene)
    # memory bounds the work, and seldom what comes of it
    return {name: wanted.value(mirror, name) for name in SETTINGS if name != "memory"}


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
    record = result.reflection_mesh
    if plays(result):
        return ""
    if lost_mirror(result):
        return "its mirror is gone, deleted or joined to another object: clear it"
    if not record.made_from:
        return ""
    # settings are no change that Blender tells of
    key = record.made_from, *settings_of(context.scene, record.mirror).values()
    return answer(_changed, context, result, key)


def _changed(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """What is no longer as it was when a result was made."""
    record = result.reflection_mesh
    if record.made_from == COARSE:
        return "Live was stopped before it was exact"
    made = read_record(record.made_from)
    if made is None:
        return ""
    sources = [source.object for source in record.sources]
    if any(map(is_gone, sources)):
        return "an object was removed"
    try:
        now = origin_of(context.evaluated_depsgraph_get(), read_view(context), mirrors_of(result), sources)
    except ReflectionError:
        # nothing can be made for it either, which whoever tries is told
        return "the camera has changed"
    origin, settings = made
    why = difference(origin, now)
    if not why and settings not in ({}, settings_of(context.scene, record.mirror)):
        why = "the settings have changed"
    # a result shows the very materials of its sources, but for previews, which are made of them
    if not why and shows_preview(result) and origin.colours not in (None, now.colours):
        why = "the colours of materials have changed"
    return why


def difference(made: Origin, now: Origin) -> str:
    """What tells two origins apart, but for colours, in a few words; empty where nothing does."""
    if made.view[32:] != now.view[32:]:
        return SIZE_DIFFERS
    if not same_view(made.view, now.view):
        return "the camera has changed"
    if made.mirror != now.mirror:
        return "the mirror has changed"
    if made.sources != now.sources:
        return "a reflected object has changed"
    # those that have other names and are made of the same are renamed ones
    if made.materials not in (None, now.materials) and made.colours != now.colours:
        return "materials have been exchanged"
    # of both the other way round there is nothing that anybody would see
    if now.through and made.through is False:
        return "the camera looks through a reflected object now"
    return "lines are drawn now" if now.lines and not made.lines else ""


def read_record(text: str) -> tuple[Origin, dict] | None:
    """The origin and the settings that `record_of` wrote; None where it wrote none."""
    if not text or len(text) > LONGEST:
        return None
    try:
        known = json.loads(text)
        origin = Origin(tuple(float(number) for number in known["view"]), str(known["mirror"]), str(known["sources"]),
                        known.get("materials"), known.get("colours"), bool(known.get("lines")),
                        known.get("through"))
        return origin, dict(known.get("settings") or {})
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def view_numbers(view: View) -> tuple[float, ...]:
    """What tells one view from another."""
    return (*view.camera_to_world.ravel().tolist(), *view.projection.ravel().tolist(), *map(float, view.resolution))
