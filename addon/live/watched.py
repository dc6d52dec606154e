"""What Live's results depend on, as it stands now: equal where nothing has changed that they show."""
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
    """What an update is made from, without anything of Blender's, which may go.

    Attributes
    ----------
    view : tuple of float
    settings : dict of int to Settings
        Of each mirror, by its `session_uid`.
    digests : tuple of (str, str, str, bool)
        Of each mirror, its sources, which materials these show, and whether the camera looks through one.
    colours : tuple of (str or None)
        Of what the materials are made of, where a result shows previews of them.
    members : tuple
        Who takes part, by `session_uid`: the camera, whose results they are; these, copies among them; of each group
        its mirrors and its sources.
    lines : bool
        Whether lines are drawn.
    """

    view: tuple[float, ...]
    settings: dict[int, Settings]
    digests: tuple[tuple, ...]
    colours: tuple[str | None, ...]
    members: tuple
    lines: bool

    def same(self, other: Record | None) -> bool:
        """Whether both tell of the same, but for rounding."""
        return (other is not None and self.settings == other.settings and self.digests == other.digests
                and self.members == other.members and self.lines == other.lines
                and same_view(self.view, other.view)
                and not any(one != last for one, last in zip(self.colours, other.colours) if None not in (one, last)))


class Watched(NamedTuple):
    """Everything that an update is made from: the view, who takes part, and the record of it."""

    view: View
    chosen: list[Participants]
    record: Record


def watched(context: bpy.types.Context, view: View, known: Record | None = None) -> Watched:
    """What the results of the scene are made from, seen by `view`; mirrors and objects are as `known` where that is
    given."""
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
    """The mirrors of results that show previews, which are made of materials and do not change with them."""
    return {obj.reflection_mesh.mirror for obj in kept_results(context) if shows_preview(obj)}


def _members(context: bpy.types.Context, chosen: list[Participants]) -> tuple:
    groups = [tuple(tuple(obj.session_uid for obj in objects) for objects in (group.mirrors, group.diffuse))
              for group in chosen]
    camera = context.scene.camera
    return (camera.session_uid if camera else 0, tuple(obj.session_uid for obj in kept_results(context)), *groups)
