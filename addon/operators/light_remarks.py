"""What light on reflections is told to be, and to lack, in sentences for the user."""
from __future__ import annotations

import bpy
import numpy as np

from ..baking import random_by_island
from ..lighting import dull_objects
from ..reading import has_fog, vectors
from ..reading.materials import surface_shaders

NAMED = 3
NOT_LIT = {"EMISSION", "BSDF_TRANSPARENT", "HOLDOUT"}  # shaders that lamps change nothing of
FOG = "Fog before what mirrors show is not in light on the objects: choose Light: Picture for a still."
ROUNDING = 1e-6  # of the largest coordinate


def unlike_the_mirror(scene: bpy.types.Scene, lit: list) -> list[str]:
    """Sentences on what `lit` show otherwise than their mirrors do, if there is anything."""
    dull = sorted({name for result in lit for name in dull_objects(result)})
    on_objects = [result for result in lit if result.reflection_mesh.light_map is not None]
    random = random_by_island(on_objects)
    astray = sorted({result.reflection_mesh.mirror.name for result in on_objects
                     if not _lies_before_mirror(result) and _is_matte(result.reflection_mesh.light_material)})
    return ([FOG] * bool(on_objects and has_fog(scene))
            + [f"The gloss of {_listed(dull)} is not what so close a curved mirror shows: choose Light: Picture for a "
             f"still."] * bool(dull)
            + [f"The matte part of {_listed(astray)} is lit where the reflection lies: choose Placement: Layered, or "
               f"Light: Picture for a still."] * bool(astray)
            + [f"What is random by island on {_listed(random)} is so in other colours: choose Light: Picture for its "
               f"own."] * bool(random))


def _lies_before_mirror(result: bpy.types.Object) -> bool:
    """Whether the mirror casts no shadow on it: that would take a result on the surface, or behind it, for its own."""
    to_world = np.array(result.matrix_world, dtype=np.float64)
    places = vectors(result.data, "position") @ to_world[:3, :3].T + to_world[:3, 3]
    on_mirror = vectors(result.data, "mirror_position")
    rounding = ROUNDING * np.abs(places).max(initial=0.0)
    return not result.reflection_mesh.window and bool((np.abs(places - on_mirror) > rounding).any())


def _is_matte(material: bpy.types.Material) -> bool:
    return any(shader.type not in NOT_LIT for shader in surface_shaders(material.node_tree))


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(f"'{name}'" for name in names[:NAMED]) + more


def summary(lit: list, seconds: float) -> str:
    """One line on what was lit."""
    if not lit:
        return "Nothing to light: the reflected materials emit what they show, and the mirrors add nothing."
    return f"{', '.join(repr(obj.name) for obj in lit)}: lit in {seconds:.2f} s"
