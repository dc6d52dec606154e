"""Group the mirrors that take part: by existing results, by hierarchies, or as the caller has planned."""
from __future__ import annotations

from functools import partial

import bpy

from ...core import Settings
from ..reading import Assembly, Participants, assemblies
from ..settings import SettingsOfMirrors, joins


def assembled(context: bpy.types.Context, chosen: Participants,
              settings: Settings | SettingsOfMirrors) -> list[Assembly]:
    """Group the chosen mirrors, each group for one result."""
    if chosen.assemblies:
        own = [one.among(chosen.mirrors) for one in chosen.assemblies]
        return [one for one in own if one.parts]
    return assemblies(context, chosen.mirrors, partial(joins, settings, context.scene))
