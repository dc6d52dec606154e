"""The inputs of a frame of an animation, compared with the present state of the scene."""
from __future__ import annotations

import bpy

from ..reading import Assembly, Participants, read_view
from .lamps import lamps_of
from .made_from import difference, origin_of, read_record, record_of

LIGHT = ""  # no mirror is called so


def frame_origin(context: bpy.types.Context, chosen: Participants | None, lit: bool) -> dict[str, str]:
    """Return the inputs of the open frame's results as text, by the names of their mirrors. If the frame is `lit`, add
    a digest of its lamps.
    """
    mirrors = [] if chosen is None else [one.among(chosen.mirrors) for one in chosen.assemblies or
                                         map(Assembly.of, chosen.mirrors)]
    # in an order that does not go by what is selected
    sources = [] if chosen is None else sorted(chosen.diffuse, key=lambda obj: obj.name_full)
    depsgraph, view = context.evaluated_depsgraph_get(), read_view(context)
    made = {one.mirror.name: record_of(origin_of(depsgraph, view, one.parts, sources), {}) for one in mirrors
            if one.parts}
    return {**made, LIGHT: lamps_of(context)} if lit else made


def frame_difference(made: dict[str, str], now: dict[str, str]) -> str:
    """Describe the first difference between the inputs of a frame when it was baked and its inputs now.

    Parameters
    ----------
    made, now : dict of str to str
        Results of `frame_origin`, at the time of the bake and now.

    Returns
    -------
    str
        A few English words, such as "the lamps or the world have changed". Empty if there is no difference, or if
        `made` is empty or cannot be read.
    """
    if not made:
        return ""
    if made.keys() != now.keys():
        return "mirrors have been shown or hidden"
    if made.get(LIGHT) != now.get(LIGHT):
        return "the lamps or the world have changed"
    for name in made.keys() - {LIGHT}:
        before, after = read_record(made[name]), read_record(now[name])
        if before is None:
            return ""
        why = difference(before[0], after[0])
        if not why and LIGHT in made and before[0].colours != after[0].colours:
            why = "the colours of materials have changed"
        if why:
            return why
    return ""
