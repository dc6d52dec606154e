"""Set the number of transparent layers that Cycles follows, while overlapping caustics need more.

Behind the last layer that it follows, Cycles shows black. A floor with more layers of light would be black, so the
number is raised if necessary, and restored when the light is removed.
"""
from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..faults import AllOrNothing, one_or_more
from ..reading.materials import shines

MOST = 1024  # limit of Blender
ROOM = 2  # safety factor, since layers are counted at sample points only
_KEPT = "reflection_mesh_transparent_layers"


def follow_layers(scene: bpy.types.Scene, layers: int, lit: Iterable[bpy.types.Material | None],
                  whole: AllOrNothing) -> list:
    """Let Cycles follow as many `layers` of light as lie on the materials `lit`. Return a list with a sentence if the
    number was changed or is too low. Glossy materials reflect the layers too, and need twice as many.
    """
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
    """Restore the number of layers in scenes without such light, unless the user changed it since. Return True if there
    were any such scenes.
    """
    found = [scene for scene in bpy.data.scenes if _KEPT in scene
             and not any(obj.reflection_mesh.role == "CAUSTICS" for obj in scene.objects)]
    for scene in found:
        before, raised = scene[_KEPT]
        del scene[_KEPT]
        if scene.cycles.transparent_max_bounces == raised:
            scene.cycles.transparent_max_bounces = before
    return bool(found)


def raises_layers() -> bool:
    """Return True if the number is raised in some scene."""
    return any(_KEPT in scene for scene in bpy.data.scenes)


def _set(scene: bpy.types.Scene, count: int, whole: AllOrNothing) -> None:
    cycles, kept = scene.cycles, scene.get(_KEPT)
    bounces = cycles.transparent_max_bounces
    whole.undo(_take_back, scene, bounces, None if kept is None else tuple(kept))
    # keep the number from before the first change, unless the user changed it since
    scene[_KEPT] = (kept[0] if kept is not None and kept[1] == bounces else bounces, count)
    cycles.transparent_max_bounces = count


def _take_back(scene: bpy.types.Scene, bounces: int, kept: tuple | None) -> None:
    scene.cycles.transparent_max_bounces = bounces
    if kept is None:
        del scene[_KEPT]
    else:
        scene[_KEPT] = kept
