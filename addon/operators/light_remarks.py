"""What light on reflections is told to be, and to lack, in sentences for the user."""
from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...core import View, draw
from ..baking import random_by_island
from ..faults import listed
from ..illumination import is_bumped
from ..lighting import dull_objects
from ..reading import has_fog, join_mirror, mirrors_of, read_meshes, read_view, vectors
from ..reading.materials import reflecting_materials, surface_shaders
from .rounding import rounding_remarks

NOT_LIT = {"EMISSION", "BSDF_TRANSPARENT", "HOLDOUT"}  # shaders that lamps change nothing of
FOG = "Fog before what mirrors show is not in light on the objects: choose Light: Picture for a still."
ACROSS = 256     # pixels of the picture in which it is looked for what windows do not show
LOST = 0.02      # of a mirror's pixels: less may be its outline
ROUNDING = 1e-6  # of the largest coordinate


def unlike_the_mirror(context: bpy.types.Context, lit: list) -> list[str]:
    """Sentences on what `lit` show otherwise than their mirrors do, if there is anything."""
    dull = sorted({name for result in lit for name in dull_objects(result)})
    on_objects = [result for result in lit if result.reflection_mesh.light_map is not None]
    random = random_by_island(on_objects)
    astray = sorted({result.reflection_mesh.mirror.name for result in on_objects
                     if not _lies_before_mirror(result) and _is_matte(result.reflection_mesh.light_material)})
    bumped = sorted({result.reflection_mesh.mirror.name for result in on_objects
                     if any(map(is_bumped, reflecting_materials(mirrors_of(result))))})
    return ([FOG] * bool(on_objects and has_fog(context.scene))
            + [f"The gloss of {listed(dull)} is not what so close a curved mirror shows: choose Light: Picture for a "
             f"still."] * bool(dull)
            + [f"The matte part of {listed(astray)} is lit where the reflection lies: choose Placement: Layered, or "
               f"Light: Picture for a still."] * bool(astray)
            + [f"What is random by island on {listed(random)} is so in other colours: choose Light: Picture for its "
               f"own."] * bool(random)
            + [f"The material of {listed(bumped)} bends its normals or displaces it, which light on the objects does "
               f"not follow: choose Light: Picture for a still, or model it."] * bool(bumped)
            + _lost_in_windows(context, lit) + rounding_remarks(context, lit))


def _lies_before_mirror(result: bpy.types.Object) -> bool:
    """Whether the mirror casts no shadow on it: that would take a result on the surface, or behind it, for its own."""
    to_world = np.array(result.matrix_world, dtype=np.float64)
    places = vectors(result.data, "position") @ to_world[:3, :3].T + to_world[:3, 3]
    on_mirror = vectors(result.data, "mirror_position")
    rounding = ROUNDING * np.abs(places).max(initial=0.0)
    return not result.reflection_mesh.window and bool((np.abs(places - on_mirror) > rounding).any())


def _lost_in_windows(context: bpy.types.Context, results: list) -> list[str]:
    """A sentence on the mirrors that are windows, and show something beside what their `results` show."""
    shown: dict[bpy.types.Object, list] = {}
    for result in results:
        # discs have no faces
        if result.reflection_mesh.window and len(result.data.polygons):
            shown.setdefault((result.reflection_mesh.mirror, *mirrors_of(result)), []).append(result)
    if not shown:
        return []
    view = read_view(context)
    size = np.ceil(np.array(view.resolution) * min(1.0, ACROSS / max(view.resolution))).astype(int).tolist()
    view = replace(view, resolution=tuple(size))
    depsgraph = context.evaluated_depsgraph_get()
    lost = [mirror.name for (mirror, *parts), own in shown.items()
            if _share_without(view, depsgraph, parts, own) > LOST]
    return [f"With Placement: Virtual, what {listed(sorted(lost))} would show beside what is reflected, as the sky, "
            "lamps or itself, is not seen: choose Layered to see it."] * bool(lost)


def _share_without(view: View, depsgraph: bpy.types.Depsgraph, parts: list, results: list) -> float:
    """The share of the pixels of a mirror in which none of `results` has anything."""
    surface = join_mirror(read_meshes(depsgraph, parts, mirror=True), parts).mesh
    of_mirror = draw(view, surface.positions, surface.triangles).triangle >= 0
    bare = of_mirror.copy()
    for result in results:
        matrix = np.array(result.matrix_world, dtype=np.float64)
        result.data.calc_loop_triangles()
        triangles = np.empty((len(result.data.loop_triangles), 3), dtype=np.int32)
        result.data.loop_triangles.foreach_get("vertices", triangles.reshape(-1))
        bare &= draw(view, vectors(result.data, "position") @ matrix[:3, :3].T + matrix[:3, 3], triangles).triangle < 0
    return float(bare.sum()) / max(int(of_mirror.sum()), 1)


def _is_matte(material: bpy.types.Material) -> bool:
    return any(shader.type not in NOT_LIT for shader in surface_shaders(material.node_tree))


def summary(lit: list, seconds: float) -> str:
    """One line on what was lit."""
    if not lit:
        return "Nothing to light: the reflected materials emit what they show, and the mirrors add nothing."
    return f"{listed(obj.name for obj in lit)}: lit in {seconds:.2f} s"
