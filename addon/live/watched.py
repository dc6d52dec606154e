"""The present inputs of Live's results. They compare equal if nothing visible has changed."""
from __future__ import annotations

from typing import NamedTuple

import bpy

from ...core import Settings, View
from ..freshness import origin_of, same_view, view_numbers
from ..lighting import shows_preview
from ..reading import Participants
from ..settings import Wanted
from .kept import groups, kept_results


class Record(NamedTuple):
    """The inputs of an update without references to Blender's data, which may be removed.

    Attributes
    ----------
    view : tuple of float
    settings : dict of int to Settings
        Settings of each mirror, by its `session_uid`.
    digests : tuple of (str, str, str, bool)
        For each mirror: digests of the mirror, of its sources and of their materials, and True if the camera looks
        through a source.
    colours : tuple of (str or None)
        For each mirror: digest of the contents of materials if a result shows previews, else None.
    members : tuple
        Participants by `session_uid`: the camera; the results and their copies; mirrors and sources of each group.
    lines : bool
        True if lines are drawn.
    """

    view: tuple[float, ...]
    settings: dict[int, Settings]
    digests: tuple[tuple, ...]
    colours: tuple[str | None, ...]
    members: tuple
    lines: bool

    def same(self, other: Record | None) -> bool:
        """Return True if both records are equal except for rounding."""
        return (other is not None and self.settings == other.settings and self.digests == other.digests
                and self.members == other.members and self.lines == other.lines
                and same_view(self.view, other.view)
                and not any(one != last for one, last in zip(self.colours, other.colours) if None not in (one, last)))


class Watched(NamedTuple):
    """Everything that an update uses: the view, the participants, and the record of the inputs."""

    view: View
    chosen: list[Participants]
    record: Record


def watched(context: bpy.types.Context, view: View, known: Record | None = None) -> Watched:
    """Return the present inputs of the scene's results, seen from `view`. If `known` is given, take the inputs of
    mirrors and objects from it.
    """
    chosen, wanted = groups(context), Wanted(context.scene)
    mirrors = [(one, group) for group in chosen for one in group.assemblies]
    settings = {one.mirror.session_uid: wanted(one.mirror) for one, _ in mirrors}
    if known is None:
        depsgraph, previewed = context.evaluated_depsgraph_get(), _previewed(context)
        origins = [(one.mirror, origin_of(depsgraph, view, one.members, group.diffuse)) for one, group in mirrors]
        digests = tuple((origin.mirror, origin.sources, origin.materials, origin.through) for _, origin in origins)
        colours = tuple(origin.colours if mirror in previewed else None for mirror, origin in origins)
        lines = any(origin.lines for _, origin in origins)
    else:
        digests, colours, lines = known.digests, known.colours, known.lines
    record = Record(view_numbers(view), settings, digests, colours, _members(context, chosen), lines)
    return Watched(view, chosen, record)


def _previewed(context: bpy.types.Context) -> set:
    """Return the mirrors of results that show previews. Previews are copies of the materials' colours."""
    return {obj.reflection_mesh.mirror for obj in kept_results(context) if shows_preview(obj)}


def _members(context: bpy.types.Context, chosen: list[Participants]) -> tuple:
    groups = [tuple(tuple(obj.session_uid for obj in objects) for objects in (group.mirrors, group.diffuse))
              for group in chosen]
    camera = context.scene.camera
    return (camera.session_uid if camera else 0, tuple(obj.session_uid for obj in kept_results(context)), *groups)
