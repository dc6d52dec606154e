"""What Live's results depend on, as it stands now: equal where nothing has changed that they show."""
from __future__ import annotations

from typing import NamedTuple

import bpy

from ...core import Settings, View
from ..freshness import origin_of, same_view, view_numbers
from ..reading import Participants
from ..settings import Wanted
from .kept import groups


class Record(NamedTuple):
    """What an update is made from, without anything of Blender's, which may go.

    Attributes
    ----------
    view : tuple of float
    settings : dict of int to Settings
        Of each mirror, by its `session_uid`.
    digests : tuple of (str, str)
        Of each mirror and its sources.
    members : tuple
        Who takes part, by `session_uid`: the camera, whose results they are; of each group its mirrors and its sources.
    """

    view: tuple[float, ...]
    settings: dict[int, Settings]
    digests: tuple[tuple[str, str], ...]
    members: tuple

    def same(self, other: Record | None) -> bool:
        """Whether both tell of the same, but for rounding."""
        return other is not None and self[1:] == other[1:] and same_view(self.view, other.view)


class Watched(NamedTuple):
    """Everything that an update is made from: the view, who takes part, and the record of it."""

    view: View
    chosen: list[Participants]
    record: Record


def watched(context: bpy.types.Context, view: View, known: Record | None = None) -> Watched:
    """What the results of the scene are made from, seen by `view`; mirrors and objects are as `known` where that is
    given."""
    chosen, wanted = groups(context), Wanted(context.scene)
    settings = {mirror.session_uid: wanted(mirror) for group in chosen for mirror in group.mirrors}
    if known is None:
        depsgraph = context.evaluated_depsgraph_get()
        digests = tuple(origin_of(depsgraph, view, mirror, group.diffuse)[1:]
                        for group in chosen for mirror in group.mirrors)
    else:
        digests = known.digests
    return Watched(view, chosen, Record(view_numbers(view), settings, digests, _members(context.scene, chosen)))


def _members(scene: bpy.types.Scene, chosen: list[Participants]) -> tuple:
    groups = [tuple(tuple(obj.session_uid for obj in objects) for objects in (group.mirrors, group.diffuse))
              for group in chosen]
    return (scene.camera.session_uid if scene.camera else 0, *groups)
