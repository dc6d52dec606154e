"""The object that carries a reflection: made or found, placed, linked beside its mirror, seen by the camera only."""
from __future__ import annotations

import json
from dataclasses import dataclass

import bpy
from mathutils import Matrix

from ...core import ReflectionMesh
from ..faults import AllOrNothing, keep_data, keep_mirror, keep_object
from ..reading.roles import results_of
from .disc_nodes import hide_discs, show_discs
from .mesh_arrays import MeshArrays
from .windows import close_window, open_window
from .write_mesh import write_mesh

RAYS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow")


@dataclass(frozen=True)
class Reflection:
    """What is to be written for one mirror.

    Attributes
    ----------
    mirror : bpy.types.Object
    sources : list of bpy.types.Object
        What is reflected in it.
    result : core.ReflectionMesh
    arrays : MeshArrays
        The same, to be written.
    resolution : (int, int)
        Of the picture that it was made for.
    """

    mirror: bpy.types.Object
    sources: list
    result: ReflectionMesh
    arrays: MeshArrays
    resolution: tuple[int, int]


def write_object(context: bpy.types.Context, made: Reflection, placement: str,
                 whole: AllOrNothing) -> bpy.types.Object:
    """The reflection in a mirror as an object: a new one, or the one that the mirror already has, updated in place.

    Where something fails, be it at a later object, `whole` takes back all that is changed here.
    """
    mirror = made.mirror
    earlier = results_of(context, mirror)
    if earlier:
        active = context.view_layer.objects.active
        obj = active if active in earlier else earlier[0]
        keep_object(obj, whole)
        keep_data(obj, whole)
    else:
        obj = new_object(context, mirror, whole)
    keep_mirror(mirror, whole)
    show_own_materials(obj)
    write_mesh(obj.data, made.arrays)
    if made.result.discs is None:
        whole.after(hide_discs, obj)
    else:
        show_discs(obj, made.arrays.uv_maps, whole)
    obj.matrix_world = Matrix.Translation(made.arrays.origin)
    _remember(obj, made)
    if placement == "VIRTUAL":
        open_window(mirror)
    else:
        close_window(mirror)
    return obj


def new_object(context: bpy.types.Context, mirror: bpy.types.Object, whole: AllOrNothing) -> bpy.types.Object:
    """An object with an empty mesh, beside the mirror, that rays other than the camera's do not meet."""
    obj = new_beside(context, f"{mirror.name} Reflection", mirror, whole)
    for rays in RAYS:
        setattr(obj, rays, False)
    # Line Art takes creases from the sharp edges alone, and no lines where layers that touch sink into each other
    obj.lineart.use_crease_override, obj.lineart.crease_threshold = True, 0.0
    obj.lineart.usage = "NO_INTERSECTION"
    return obj


def new_beside(context: bpy.types.Context, name: str, other: bpy.types.Object,
               whole: AllOrNothing) -> bpy.types.Object:
    """An object with an empty mesh in the collections of another, those of this scene that can be changed, else in the
    scene's own."""
    mesh = bpy.data.meshes.new(name)
    whole.undo(bpy.data.meshes.remove, mesh)
    obj = bpy.data.objects.new(name, mesh)
    whole.undo(bpy.data.objects.remove, obj)
    of_scene = {context.scene.collection, *context.scene.collection.children_recursive}
    beside = [collection for collection in other.users_collection
              if collection in of_scene and collection.library is None]
    for collection in beside or [context.scene.collection]:
        collection.objects.link(obj)
    return obj


def _remember(obj: bpy.types.Object, made: Reflection) -> None:
    record, result = obj.reflection_mesh, made.result
    record.role = "REFLECTION"
    record.mirror = made.mirror
    record.sources.clear()
    for source in made.sources:
        record.sources.add().object = source
    record.estimated_error = result.estimated_error
    record.counts = json.dumps({name: int(count) for name, count in result.counts.items()})
    record.resolution = made.resolution
    record.faces = len(obj.data.polygons)
    record.points = 0 if result.discs is None else len(result.positions)


def show_own_materials(obj: bpy.types.Object) -> None:
    """Let an object show the materials of its mesh, and none of its own."""
    for slot in obj.material_slots:
        if slot.link == "OBJECT":
            # first, since a slot that goes keeps what it held counted as used
            slot.material = None
            slot.link = "DATA"
