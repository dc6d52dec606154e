"""Light linking: whether a linked lamp lights an object, or is blocked by it."""
from __future__ import annotations

import bpy

LINKS = ("receiver_collection", "blocker_collection")


def is_linked(obj: bpy.types.Object) -> bool:
    """Return True where the light linking of some lamp names an object, and so would not name a copy of it."""
    linked = {getattr(lamp.light_linking, link) for lamp in bpy.data.objects for link in LINKS} - {None}
    return any(link_state(collection, obj) is not None for collection in linked)


def link_state(collection: bpy.types.Collection, obj: bpy.types.Object) -> str | None:
    """INCLUDE or EXCLUDE; None where a collection does not tell of an object. Of what does the last counts, and objects
    come after collections."""
    states = [(entry.light_linking.link_state, obj.name in child.all_objects)
              for entry, child in zip(collection.collection_children, collection.children)]
    states += [(entry.light_linking.link_state, child == obj)
               for entry, child in zip(collection.collection_objects, collection.objects)]
    return next((state for state, holds in reversed(states) if holds), None)
