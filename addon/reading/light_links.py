"""What light linking says of an object: whether a linked lamp lights it, or is blocked by it."""
from __future__ import annotations

import bpy


def link_state(collection: bpy.types.Collection, obj: bpy.types.Object) -> str | None:
    """INCLUDE or EXCLUDE; None where a collection does not tell of an object. Of what does the last counts, and objects
    come after collections."""
    states = [(entry.light_linking.link_state, obj.name in child.all_objects)
              for entry, child in zip(collection.collection_children, collection.children)]
    states += [(entry.light_linking.link_state, child == obj)
               for entry, child in zip(collection.collection_objects, collection.objects)]
    return next((state for state, holds in reversed(states) if holds), None)
