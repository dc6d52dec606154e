"""Results that a scene has: of which mirror, for which camera, and which of them a selection means."""
from __future__ import annotations

import bpy

from ...core import ReflectionError

RESULTS = {"REFLECTION", "CAUSTICS"}


def is_result(obj: bpy.types.Object) -> bool:
    """Return True for an object that is a generated reflection."""
    return obj.reflection_mesh.role == "REFLECTION"


def has_linked_results() -> bool:
    """Return True if the file has results that are linked from another file, as objects or in collection instances."""
    return any(obj.library is not None and obj.reflection_mesh.role in RESULTS for obj in bpy.data.objects)


def results_of(context: bpy.types.Context, mirror: bpy.types.Object, among: list | None = None) -> list:
    """Return the results of `mirror` for the scene's camera that can be changed, from the scene or from the list
    `among`.

    If none belongs to that camera, return results without a camera, which earlier versions made.
    """
    every = every_result_of(context, mirror, among)
    own = [obj for obj in every if camera_of(obj) == context.scene.camera]
    return own or [obj for obj in every if camera_of(obj) is None]


def every_result_of(context: bpy.types.Context, mirror: bpy.types.Object, among: list | None = None) -> list:
    """Return the results of `mirror` for every camera, see `results_of`."""
    return [obj for obj in (context.scene.objects if among is None else among) if is_result(obj)
            and (obj.reflection_mesh.mirror == mirror or mirror in mirrors_of(obj))
            and obj.type == "MESH" and obj.library is None]


def mirrors_of(result: bpy.types.Object) -> list:
    """Return the objects that reflect in a result: its mirror, or the parts that are joined in it, without those that
    have been deleted unless all have."""
    record = result.reflection_mesh
    if record.mirror is None:
        return []
    parts = [part.object for part in record.parts if part.object is not None]
    return [obj for obj in parts if not is_gone(obj)] or parts or [record.mirror]


def lost_mirror(result: bpy.types.Object) -> bool:
    """Return True if the mirror of a result, or all of its parts, have been deleted."""
    return all(map(is_gone, mirrors_of(result)))


def named_by_selection(context: bpy.types.Context, results: list) -> list:
    """Return the results that are selected, or whose mirror or its parts are. If there are none, return the active
    result if it cannot be selected (`hide_select`).
    """
    selected, active = set(context.selected_objects), context.view_layer.objects.active
    named = [obj for obj in results
             if not selected.isdisjoint((obj, obj.reflection_mesh.mirror, *mirrors_of(obj)))]
    return named or [obj for obj in results if obj == active and obj.hide_select]


def result_of(context: bpy.types.Context, obj: bpy.types.Object | None, known: list) -> bpy.types.Object | None:
    """Return the reflection that an object stands for: itself, or the one in it that the scene's camera sees.

    Parameters
    ----------
    known : list of bpy.types.Object
        The results of the scene, as of `known_results`.
    """
    if obj is None or is_result(obj):
        return obj
    return next(iter(results_of(context, obj, known)), None)


def with_copies(context: bpy.types.Context, results: list) -> list:
    """Return the results and their copies by the user: results of the same mirror for the same camera."""
    found = dict.fromkeys(results)
    for result in results:
        found.update(dict.fromkeys(obj for obj in every_result_of(context, result.reflection_mesh.mirror)
                                   if camera_of(obj) == camera_of(result)))
    return list(found)


def with_joined(context: bpy.types.Context, mirrors: list) -> list:
    """Return `mirrors`, and the parts that are joined with one of them in a result."""
    found = dict.fromkeys(mirrors)
    for result in context.scene.objects:
        if is_result(result) and len(result.reflection_mesh.parts):
            parts = mirrors_of(result)
            if not found.keys().isdisjoint(parts):
                found.update(dict.fromkeys(part for part in parts if part.reflection_mesh.role in {"AUTO", "MIRROR"}))
    return list(found)


def camera_of(result: bpy.types.Object) -> bpy.types.Object | None:
    """Return the camera that a result was made for. Return None if it fits any camera, or if its camera was deleted."""
    camera = result.reflection_mesh.camera
    return None if is_gone(camera) else camera


def is_gone(obj: bpy.types.Object | None) -> bool:
    """Return True if an object that a result refers to is None, or was deleted or joined to another object."""
    # deleted objects that are still referenced exist without a scene
    return obj is None or not obj.users_scene


def meant(context: bpy.types.Context, active: bpy.types.Object | None) -> list:
    """Return the results that a selection without objects to reflect refers to, the active one's first. These are
    selected results, the active result even if it is not selected, and results of selected mirrors.
    """
    selected = [obj for obj in context.view_layer.objects
                if obj.select_get() or (obj == active and obj.reflection_mesh.role in RESULTS)]
    selected.sort(key=lambda obj: obj != active)
    # compute results only for objects that are mirrors: thousands of others may be selected
    results = [obj for obj in context.scene.objects if is_result(obj)]
    reflected = {mirror for obj in results for mirror in (obj.reflection_mesh.mirror, *mirrors_of(obj))}
    found: dict = {}
    for obj in selected:
        made = obj.reflection_mesh.role in RESULTS
        if made or obj in reflected:
            own = [obj] if made else results_of(context, obj)
            found.update(dict.fromkeys(result for result in own if result.reflection_mesh.mirror is not None))
    return list(found)


def showing(context: bpy.types.Context, objects: list) -> list:
    """Return the results of mirrors that show any of some objects to the scene's camera."""
    chosen = set(objects)
    mirrors = {obj.reflection_mesh.mirror: None for obj in (context.scene.objects if chosen else ())
               if is_result(obj) and not is_gone(obj.reflection_mesh.mirror) and chosen.intersection(_sources(obj))}
    return [result for mirror in mirrors for result in results_of(context, mirror)
            if chosen.intersection(_sources(result))]


def of_results(results: list) -> tuple[list, list]:
    """Return the mirrors of `results`, and the objects that all of these results show.

    Raises
    ------
    ReflectionError
        If the results show different objects, or if a mirror is among the objects.
    """
    diffuse = _sources(results[0])
    other = next((result for result in results if set(_sources(result)) != set(diffuse)), None)
    if other is not None:
        raise ReflectionError(f"'{results[0].name}' and '{other.name}' show different objects: select one of them, or "
                              "the mirrors together with what they shall show.")
    mirrors = list(dict.fromkeys(mirror for result in results for mirror in mirrors_of(result)))
    both = next((mirror for mirror in mirrors if mirror in diffuse), None)
    if both is not None:
        raise ReflectionError(f"'{both.name}' is both the mirror and a source of '{results[0].name}': choose another "
                              "mirror or remove it from the sources.")
    return mirrors, diffuse


def _sources(result: bpy.types.Object) -> list:
    return [source.object for source in result.reflection_mesh.sources if source.object is not None]
