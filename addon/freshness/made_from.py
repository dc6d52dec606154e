"""Record the inputs of a result, and find the inputs that have changed since."""
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

SAME = 1e-6  # relative to the largest number of a matrix; tolerance for transforms that were changed and restored
SIZE_DIFFERS = "the picture's size has changed"
LONGEST = 20_000  # characters of a record; its own are below a thousand
# the record of a result that was left before it was exact
COARSE = json.dumps({"coarse": True})


class Origin(NamedTuple):
    """The inputs of a result.

    Attributes
    ----------
    view : tuple of float
        See `view_numbers`.
    mirror, sources : str
        Digests of the mirror and of the reflected objects.
    materials : str or None
        Digest of the names of their materials; None if an earlier version did not record it.
    colours : str or None
        Digest of the contents of the materials, or None.
    lines : bool
        True if Line Art or Freestyle draws lines.
    through : bool or None
        True if the camera may look through a source that is hidden from it; None if not recorded.
    """

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
    """Return the text that a result stores; `settings` are those that its file had for it."""
    return json.dumps({**origin._asdict(), "view": [float(f"{number:.8g}") for number in origin.view],
                       "settings": settings})


def settings_of(scene: bpy.types.Scene, mirror: bpy.types.Object) -> dict:
    """Return the scene's settings for a mirror that its reflection depends on."""
    wanted = Wanted(scene)
    # memory bounds the work, and seldom what comes of it
    return {name: wanted.value(mirror, name) for name in SETTINGS if name != "memory"}


def same_view(one: tuple, other: tuple) -> bool:
    """Return True if two views are equal except for rounding."""
    if len(one) != len(other) or one[32:] != other[32:]:
        return False
    return all(np.allclose(a, b, rtol=0.0, atol=SAME * max(np.abs(b).max(), 1e-300))
               for a, b in zip(np.reshape(one[:32], (2, 16)), np.reshape(other[:32], (2, 16))))


def why_stale(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return what has changed since a result was made, in a few words; "" if nothing has or it is unknown.

    Cheap: the answer is cached until something changes again.
    """
    record = result.reflection_mesh
    if plays(result):
        return ""
    if lost_mirror(result):
        return "its mirror is gone, deleted or joined to another object: clear it"
    if not record.made_from:
        return ""
    # Blender does not report changes of settings
    key = record.made_from, *settings_of(context.scene, record.mirror).values()
    return answer(_changed, context, result, key)


def _changed(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return the first input of a result that has changed, in a few words."""
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
        # no new result is possible either; the user learns why on trying
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
    """Return the first difference between two records, except for colours, in a few words; "" if there is none."""
    if made.view[32:] != now.view[32:]:
        return SIZE_DIFFERS
    if not same_view(made.view, now.view):
        return "the camera has changed"
    if made.mirror != now.mirror:
        return "the mirror has changed"
    if made.sources != now.sources:
        return "a reflected object has changed"
    # materials with other names but equal contents were only renamed
    if made.materials not in (None, now.materials) and made.colours != now.colours:
        return "materials have been exchanged"
    # the opposite changes are invisible
    if now.through and made.through is False:
        return "the camera looks through a reflected object now"
    return "lines are drawn now" if now.lines and not made.lines else ""


def read_record(text: str) -> tuple[Origin, dict] | None:
    """Return the origin and the settings from a text of `record_of`; None for any other text."""
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
    """Return the numbers that identify a view: both matrices (16 each) and the resolution."""
    return (*view.camera_to_world.ravel().tolist(), *view.projection.ravel().tolist(), *map(float, view.resolution))
