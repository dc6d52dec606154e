"""The materials that an object shows, be they its own or those of the collection that it is an instance of."""
from __future__ import annotations

import bpy


def materials_of(obj: bpy.types.Object) -> list:
    """One for each slot, None where that is empty."""
    own = [slot.material for slot in obj.material_slots]
    if obj.instance_type != "COLLECTION" or obj.instance_collection is None:
        return own
    return own + [material for other in obj.instance_collection.all_objects for material in materials_of(other)]
