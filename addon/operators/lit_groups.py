"""Select the results that can be lit: their mirror exists, and they belong to the scene's camera."""
from __future__ import annotations

import bpy

from ...core import ReflectionError
from ..reading import camera_of, in_viewports, lost_mirror, mirrors_of


def with_mirrors(context: bpy.types.Context, groups: list[tuple[list, int]]) -> list[tuple[list, int]]:
    """Return the groups without results whose mirror is deleted or hidden, and without those that are not meshes. The
    panel reports these.
    """
    # mirrors hidden in renders only are lit as usual
    there = in_viewports(context)
    own = [([result for result in results if result.type == "MESH" and not there.isdisjoint(mirrors_of(result))],
            samples)
           for results, samples in groups]
    if not any(results for results, _ in own):
        lost = next(result for results, _ in groups for result in results)
        if lost_mirror(lost):
            raise ReflectionError(f"The mirror of '{lost.name}' is gone: clear it, or select another mirror.")
        if lost.type != "MESH":
            raise ReflectionError(f"'{lost.name}' is no mesh any more: generate the reflection again.")
        mirror, *_ = mirrors_of(lost)
        raise ReflectionError(f"The mirror '{mirror.name}' is hidden: show it in the viewport and in renders.")
    return own


def for_the_camera(camera: bpy.types.Object, groups: list[tuple[list, int]]) -> list[tuple[list, int]]:
    """Return the groups without the results of other cameras."""
    own = [([result for result in results if camera_of(result) in (None, camera)], samples)
           for results, samples in groups]
    if not any(results for results, _ in own):
        other = next(result for results, _ in groups for result in results)
        raise ReflectionError(f"'{other.name}' is for the camera '{camera_of(other).name}': make that the scene's "
                              f"camera, or generate the reflection for '{camera.name}' too.")
    return own
