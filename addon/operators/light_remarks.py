"""Messages to the user about lit reflections: what was lit, and how it differs from the mirrors."""
from __future__ import annotations

import bpy

from .. import compat
from ..faults import listed
from ..illumination import is_bumped
from ..reading import materials_of, mirrors_of
from ..reading.materials import all_nodes, reflecting_materials
from .rounding import rounding_remarks


def unlike_the_mirror(context: bpy.types.Context, lit: list) -> list[str]:
    """Sentences on what `lit` show otherwise than their mirrors do, if there is anything."""
    bumped = sorted({result.reflection_mesh.mirror.name for result in lit
                     if any(map(is_bumped, reflecting_materials(mirrors_of(result))))})
    by_camera = sorted({source.name for result in lit for source in _sources(result)
                        if any(map(_asks_camera, materials_of(source)))})
    return ([f"{listed(by_camera)} use Camera or Window coordinates or Camera Data, which light sees from elsewhere: "
             f"use other coordinates."] * bool(by_camera)
            + [f"The material of {listed(bumped)} bends its normals or displaces it, which a reflection does not "
               f"follow: model it."] * bool(bumped)
            + rounding_remarks(context, lit))


def _sources(result: bpy.types.Object) -> set:
    return {entry.object for entry in result.reflection_mesh.sources} - {None}


def _asks_camera(material: bpy.types.Material | None) -> bool:
    """Return True if a material goes by where the camera is."""
    if material is None or not compat.uses_nodes(material):
        return False
    return any(node.type == "CAMERA" or node.type == "TEX_COORD" and any(
        node.outputs[name].is_linked for name in ("Camera", "Window")) for node in all_nodes(material.node_tree))


def summary(lit: list, seconds: float) -> str:
    """One line on what was lit."""
    return f"{listed(obj.name for obj in lit)}: lit in {seconds:.2f} s"
