"""Lamps that stand in instances alone, and so are none that light is thrown of."""
from __future__ import annotations

import bpy

from ...reading import seen_in

BY_CHILDREN = {"VERTS", "FACES"}


def instancers_of_lamps(context: bpy.types.Context) -> list:
    """Return the visible objects of the view layer that instance lamps: the selected ones, or all if no lamp is
    selected.
    """
    objects = context.view_layer.objects
    all_of_them, is_seen = not any(obj.type == "LIGHT" and obj.select_get() for obj in objects), seen_in(context)
    return [obj for obj in objects if (all_of_them or obj.select_get()) and _instances_lamps(obj) and is_seen(obj)]


def _instances_lamps(obj: bpy.types.Object) -> bool:
    if obj.instance_type == "COLLECTION" and obj.instance_collection is not None:
        return any(other.type == "LIGHT" and not other.hide_render for other in obj.instance_collection.all_objects)
    return obj.instance_type in BY_CHILDREN and any(child.type == "LIGHT" for child in obj.children)
