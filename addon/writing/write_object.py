"""The object that carries a reflection: made or found, placed, linked beside its mirror, seen by the camera only."""
from __future__ import annotations

import json
from dataclasses import dataclass

import bpy

from ...core import ReflectionMesh, Settings
from ..faults import AllOrNothing, keep_data, keep_mirror, keep_object, still_there
from ..reading import Assembly, every_result_of, results_of
from .arrays import MeshArrays
from .beside import link_beside
from .cameras import bring_back
from .joined_parts import set_free
from .kept_changes import Changes, changes_of, place
from .nodes import hide_discs, show_discs
from .windows import set_window
from .write_mesh import write_mesh

RAYS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow")


@dataclass(frozen=True)
class Reflection:
    """The result for one mirror, before it is written.

    Attributes
    ----------
    joint : Assembly
        The mirror, or the parts of a joined one.
    camera : bpy.types.Object
        The camera for which the result is right.
    sources : list of bpy.types.Object
        The reflected objects, followed by those that are hidden at the moment.
    result : core.ReflectionMesh
    arrays : MeshArrays
        The arrays of `result` to write.
    resolution : (int, int)
        Size in pixels of the picture that it was made for.
    settings : core.Settings
        Settings of the generation. The placement VIRTUAL makes a window of the mirror.
    attributes : {'ALL', 'SHOWN'}
        Attributes of the arrays to write.
    world_faces : {'NEVER', 'LIT', 'ALWAYS'}
        Condition for faces that show the world.
    """

    joint: Assembly
    camera: bpy.types.Object
    sources: list
    result: ReflectionMesh
    arrays: MeshArrays
    resolution: tuple[int, int]
    settings: Settings
    attributes: str = "ALL"
    world_faces: str = "LIT"

    @property
    def mirror(self) -> bpy.types.Object:
        """The object that the result points to."""
        return self.joint.mirror


@dataclass(frozen=True)
class Written:
    """A written result: its object `obj`, the user's changes of it, `copy` (True for a copy of another result), and the
    object `freed` that holds parts which the user had joined to it.
    """

    obj: bpy.types.Object
    changes: Changes
    copy: bool
    freed: bpy.types.Object | None = None


def write_object(context: bpy.types.Context, made: Reflection, whole: AllOrNothing) -> list[Written]:
    """Write the reflection in a mirror into an object: a new one, or the mirror's result for the scene's camera, which
    is updated in place together with the user's copies of it.

    If something fails, even at a later object, `whole` undoes all changes made here.

    Returns
    -------
    written : list of Written
        The result, and its copies.
    """
    earlier = results_of(context, made.mirror)
    for part in made.joint.members:
        keep_mirror(part, whole)
    if not earlier:
        obj = new_object(context, made.joint, whole)
        _fill(obj, made, whole, Changes(None, [], []), obj.data)
        set_window(obj, made.settings.placement)
        return [Written(obj, Changes(None, [], []), False)]
    active = context.view_layer.objects.active
    # the active one first
    earlier.sort(key=lambda obj: obj != active)
    shared = earlier[0].data
    written = [Written(obj, changes_of(obj), obj != earlier[0],
                       set_free(context, obj, whole) if obj == earlier[0] or obj.data != shared else None)
               for obj in earlier]
    for entry in written:
        obj = entry.obj
        keep_object(obj, whole)
        linked = entry.copy and obj.data == shared
        if linked:
            whole.undo(setattr, obj, "data", shared)
            obj.data = earlier[0].data
        else:
            keep_data(obj, whole)
        _fill(obj, made, whole, entry.changes, None if linked else obj.data)
        set_window(obj, made.settings.placement)
    whole.after(forget_mesh, shared)
    return written


def forget_mesh(mesh: bpy.types.Mesh) -> None:
    """Remove a mesh that has no users any more."""
    if still_there([mesh]) and not mesh.users and mesh.library is None:
        bpy.data.meshes.remove(mesh)


def _fill(obj: bpy.types.Object, made: Reflection, whole: AllOrNothing, changes: Changes,
          mesh: bpy.types.Mesh | None) -> None:
    """Write a result: its mesh, if it has one of its own, its transform and its record."""
    _remember(obj, made)
    show_own_materials(obj)
    if obj.data.shape_keys is not None:
        obj.shape_key_clear()
    arrays = made.arrays
    if obj.reflection_mesh.attributes == "SHOWN":
        arrays = arrays.seen_in([*arrays.materials, *(material for _, _, material in changes.materials)])
    if mesh is not None:
        write_mesh(mesh, arrays)
    if made.result.discs is None:
        whole.after(hide_discs, obj)
    else:
        show_discs(obj, arrays.uv_maps, whole)
    _count(obj, made)
    place(obj, arrays.origin, changes)


def new_object(context: bpy.types.Context, joint: Assembly, whole: AllOrNothing) -> bpy.types.Object:
    """Create an object with an empty mesh beside the mirror, visible to camera rays only. It is a holdout if the mirror
    is one. Its name contains the camera if the mirror has results for other cameras.
    """
    camera = context.scene.camera.name if every_result_of(context, joint.mirror) else ""
    obj = new_beside(context, result_name(joint.mirror, camera), joint.members[0], whole)
    for rays in RAYS:
        setattr(obj, rays, False)
    obj.is_holdout = joint.members[0].is_holdout
    # Line Art takes creases from the sharp edges alone, and no lines where layers that touch sink into each other
    obj.lineart.use_crease_override, obj.lineart.crease_threshold = True, 0.0
    obj.lineart.usage = "NO_INTERSECTION"
    return obj


def result_name(mirror: bpy.types.Object, told_by: str) -> str:
    """Return the name of a result of `mirror` with the suffix `told_by`. The mirror's name is shortened so that
    Blender, which cuts the end of long names, does not cut the suffix.
    """
    end = f" Reflection {told_by}".rstrip()
    longest = bpy.types.ID.bl_rna.properties["name"].length_max - 1
    kept = max(longest - len(end.encode()), longest // 3)
    return mirror.name.encode()[:kept].decode(errors="ignore") + end


def new_beside(context: bpy.types.Context, name: str, other: bpy.types.Object,
               whole: AllOrNothing) -> bpy.types.Object:
    """Create an object with an empty mesh in the collections of another object. It stands at the world origin.

    Parameters
    ----------
    context : bpy.types.Context
    name : str
        Name of the object and of its mesh.
    other : bpy.types.Object
        The object whose collections are used, see `link_beside`.
    whole : AllOrNothing
        Removes the object and its mesh again if its block fails.
    """
    mesh = bpy.data.meshes.new(name)
    whole.undo(bpy.data.meshes.remove, mesh)
    obj = bpy.data.objects.new(name, mesh)
    whole.undo(bpy.data.objects.remove, obj)
    link_beside(context.scene, obj, other)
    return obj


def _remember(obj: bpy.types.Object, made: Reflection) -> None:
    record, result = obj.reflection_mesh, made.result
    record.role = "REFLECTION"
    record.mirror = made.mirror
    remember_parts(record, made.joint)
    record.camera = made.camera
    bring_back(obj)
    record.attributes, record.hidden_faces = made.attributes, made.settings.hidden_faces
    # automatic bounces are as many as there were to see
    record.bounces = int(result.counts.get("depth", made.settings.bounces))
    record.world_faces = made.world_faces
    record.sources.clear()
    for source in made.sources:
        record.sources.add().object = source
    record.later_materials.clear()
    for material in made.arrays.later_materials:
        record.later_materials.add().material = material
    record.estimated_error = result.estimated_error
    record.counts = json.dumps({name: int(count) for name, count in result.counts.items()})
    record.resolution = made.resolution


def remember_parts(record: bpy.types.PropertyGroup, joint: Assembly) -> None:
    """Record the objects that a result's mirror is joined from."""
    record.parts.clear()
    for part in joint.members if joint.is_joined else ():
        record.parts.add().object = part


def _count(obj: bpy.types.Object, made: Reflection) -> None:
    obj.reflection_mesh.faces = len(obj.data.polygons)
    obj.reflection_mesh.points = 0 if made.result.discs is None else len(made.result.positions)


def show_own_materials(obj: bpy.types.Object) -> None:
    """Make an object show the materials of its mesh instead of its own."""
    for slot in obj.material_slots:
        if slot.link == "OBJECT":
            # first, since a slot that goes keeps what it held counted as used
            slot.material = None
            slot.link = "DATA"
