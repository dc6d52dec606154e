"""How many transparent layers Cycles follows: as many as light lies over each other, as long as there is such light.

Behind the last layer that it follows Cycles is dark. A floor with more layers of light on it would be black, so the
number is raised where it has to be, and brought back with the light.
"""
from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..faults import AllOrNothing, one_or_more
from ..reading.materials import shines

MOST = 1024  # that Blender takes
ROOM = 2  # times as many as were found: layers are counted in places
_KEPT = "reflection_mesh_transparent_layers"


def follow_layers(scene: bpy.types.Scene, layers: int, lit: Iterable[bpy.types.Material | None],
                  whole: AllOrNothing) -> list:
    """Let Cycles follow as many `layers` of light as lie on the materials that are `lit`; a sentence where that was
    changed, or not enough. What a glossy material mirrors passes its own layers twice."""
    bounces = scene.cycles.transparent_max_bounces
    if scene.render.engine != "CYCLES" or 2 * layers <= bounces:
        return []
    if any(map(shines, lit)):
        layers *= 2
    if layers <= bounces:
        return []
    raised = min(ROOM * layers, MOST)
    _set(scene, raised, whole)
    if layers > MOST:
        return [f"Cycles follows {MOST} transparent layers, and {layers} or more of light have to be passed, so that "
                "it is dark behind them: lower Lamp Places or the depth."]
    followed = one_or_more(bounces, "1 transparent layer", "{count} transparent layers")
    return [f"Cycles followed {followed}, and {layers} or more of light have to be passed: Light "
            f"Paths > Max Bounces > Transparent is {raised} until the light is cleared."]


def bring_back_layers() -> bool:
    """Let Cycles follow as many layers as before in scenes without such light; whether there were any. What was changed
    by hand since stays."""
    found = [scene for scene in bpy.data.scenes if _KEPT in scene
             and not any(obj.reflection_mesh.role == "CAUSTICS" for obj in scene.objects)]
    for scene in found:
        before, raised = scene[_KEPT]
        del scene[_KEPT]
        if scene.cycles.transparent_max_bounces == raised:
            scene.cycles.transparent_max_bounces = before
    return bool(found)


def raises_layers() -> bool:
    """Whether the number is raised in some scene."""
    return any(_KEPT in scene for scene in bpy.data.scenes)


def _set(scene: bpy.types.Scene, count: int, whole: AllOrNothing) -> None:
    cycles, kept = scene.cycles, scene.get(_KEPT)
    bounces = cycles.transparent_max_bounces
    whole.undo(_take_back, scene, bounces, None if kept is None else tuple(kept))
    # what was there before the first time, unless it was changed by hand since
    scene[_KEPT] = (kept[0] if kept is not None and kept[1] == bounces else bounces, count)
    cycles.transparent_max_bounces = count


def _take_back(scene: bpy.types.Scene, bounces: int, kept: tuple | None) -> None:
    scene.cycles.transparent_max_bounces = bounces
    if kept is None:
        del scene[_KEPT]
    else:
        scene[_KEPT] = kept
