"""Lamps for stand-ins: they light them, and are blocked by them, as what they stand for, and as mirrors show that."""
from __future__ import annotations

from contextlib import ExitStack

import bpy

from ...faults import still_there
from ...reading import LINKS, link_state


def link_lamps(stands: list[tuple[bpy.types.Object, bpy.types.Object]], back: ExitStack) -> None:
    """Let collections that lamps are linked to tell of each stand-in, (source, stand-in), what they tell of its source:
    by copies of them, until the stack takes it back."""
    copies: dict = {}
    for lamp in bpy.data.objects:
        for link in LINKS:
            collection = getattr(lamp.light_linking, link)
            if collection is None:
                continue
            if collection not in copies:
                copies[collection] = _with_stand_ins(collection, stands, back)
            if copies[collection] is not None:
                back.callback(setattr, lamp.light_linking, link, collection)
                setattr(lamp.light_linking, link, copies[collection])


def count_the_mirror(scene: bpy.types.Scene, back: ExitStack) -> None:
    """Let lamps that light no more than so many bounces light one less, until the stack takes it back: what is seen
    by way of a mirror comes one bounce later than in a bake."""
    known: dict = {}
    for obj in [obj for obj in scene.objects if obj.type == "LIGHT"]:
        cycles = obj.data.cycles
        most = known.setdefault(obj.data, cycles.max_bounces)
        if most == 0:
            back.callback(setattr, obj, "hide_render", obj.hide_render)
            obj.hide_render = True
        elif cycles.max_bounces == most <= scene.cycles.max_bounces:
            back.callback(setattr, cycles, "max_bounces", most)
            cycles.max_bounces = most - 1


def _with_stand_ins(collection: bpy.types.Collection, stands: list, back: ExitStack) -> bpy.types.Collection | None:
    """A copy of a collection that tells of stand-ins too; None where there is nothing to tell."""
    told = {source: link_state(collection, source) for source, _ in stands}
    wanted = {obj: told[source] for source, obj in stands if told[source] is not None}
    if not wanted:
        return None
    copy = collection.copy()
    back.callback(lambda: bpy.data.batch_remove(still_there([copy])))
    for obj in wanted:
        copy.objects.link(obj)
    for entry, obj in zip(copy.collection_objects, copy.objects):
        if obj in wanted:
            entry.light_linking.link_state = wanted[obj]
    return copy
