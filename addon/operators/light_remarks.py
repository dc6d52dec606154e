"""What light on reflections is told to be, and to lack, in sentences for the user."""
from __future__ import annotations

import bpy

from ..baking import random_by_island
from ..lighting import dull_objects
from ..reading import has_fog

NAMED = 3
FOG = "Fog before what mirrors show is not in light on the objects: choose Light: Picture for a still."


def unlike_the_mirror(scene: bpy.types.Scene, lit: list) -> list[str]:
    """Sentences on what `lit` show otherwise than their mirrors do, if there is anything."""
    dull = sorted({name for result in lit for name in dull_objects(result)})
    on_objects = [result for result in lit if result.reflection_mesh.light_map is not None]
    random = random_by_island(on_objects)
    return ([FOG] * bool(on_objects and has_fog(scene))
            + [f"The gloss of {_listed(dull)} is not what so close a curved mirror shows: choose Light: Picture for a "
             f"still."] * bool(dull)
            + [f"What is random by island on {_listed(random)} is so in other colours: choose Light: Picture for its "
               f"own."] * bool(random))


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(f"'{name}'" for name in names[:NAMED]) + more


def summary(lit: list, seconds: float) -> str:
    """One line on what was lit."""
    if not lit:
        return "Nothing to light: the reflected materials emit what they show, and the mirrors add nothing."
    return f"{', '.join(repr(obj.name) for obj in lit)}: lit in {seconds:.2f} s"
