"""The results of a scene that Live keeps up to date, grouped by the objects that they show."""
from __future__ import annotations

from dataclasses import replace

import bpy

from ...core import ReflectionError
from ..frames import plays
from ..reading import (
    Assembly,
    Participants,
    is_gone,
    is_result,
    known_results,
    lost_mirror,
    mirrors_of,
    results_of,
    visible,
)


def kept_results(context: bpy.types.Context) -> list:
    """Return the results of the scene that are updated when something moves."""
    known = known_results(context.scene, context.view_layer)
    return [obj for obj in _made_here(known) if not lost_mirror(obj)
            and obj in results_of(context, obj.reflection_mesh.mirror, known)]


def abandoned_results(context: bpy.types.Context) -> list:
    """Return the results of the scene that cannot be updated because their mirror is deleted."""
    known = known_results(context.scene, context.view_layer)
    return [obj for obj in _made_here(known) if obj.library is None and lost_mirror(obj)]


def abandoned_light(context: bpy.types.Context) -> list:
    """Return the caustics that cannot be updated because their mirror or lamp is deleted."""
    return [obj for obj in kept_light(context)
            if is_gone(obj.reflection_mesh.mirror) or is_gone(obj.reflection_mesh.lamp)]


def _made_here(known: list) -> list:
    return [obj for obj in known if is_result(obj) and obj.type == "MESH" and not plays(obj)]


def kept_light(context: bpy.types.Context) -> list:
    """Return the caustics of the scene that can be changed."""
    return [obj for obj in known_results(context.scene, context.view_layer) if obj.reflection_mesh.role == "CAUSTICS"
            and obj.type == "MESH" and obj.library is None and not plays(obj)]


def groups(context: bpy.types.Context) -> list[Participants]:
    """Return the mirrors and objects of these results, grouped; hidden ones do not take part."""
    found: dict = {}
    for obj in kept_results(context):
        mirrors, sources = mirrors_of(obj), _sources(obj)
        if sources and set(mirrors).isdisjoint(sources):
            found.setdefault(sources, {})[obj.reflection_mesh.mirror] = mirrors
    chosen = []
    for sources, joint in found.items():
        try:
            seen = visible(context, [part for parts in joint.values() for part in parts], list(sources))
        except ReflectionError:
            continue
        there = set(seen.mirrors)
        own = (Assembly(mirror, [part for part in parts if part in there], parts) for mirror, parts in joint.items())
        chosen.append(replace(seen, assemblies=tuple(one for one in own if one.parts)))
    return chosen


def why_not_kept(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return a sentence on why a result cannot be updated now; "" if it can."""
    try:
        visible(context, mirrors_of(result), list(_sources(result)))
    except ReflectionError as error:
        return str(error)
    return ""


def _sources(result: bpy.types.Object) -> tuple:
    return tuple(source.object for source in result.reflection_mesh.sources if source.object is not None)
