"""Restore a result and its mirror if writing fails."""
from __future__ import annotations

import bpy

from .all_or_nothing import AllOrNothing

PLACE = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale")
RECORD = ("role", "mirror", "lamp", "eyes", "keeps_own", "camera", "window", "attributes", "estimated_error", "seconds",
          "counts", "faces", "points", "made_from", "light", "light_material", "lit_from", "hidden_faces", "bounces",
          "world_faces", "protected")
NUMBERS = ("resolution", "origin", "basis", "landmarks", "landmark_places", "aside")


def still_there(items: list) -> list:
    """Return the items of Blender's data that have not been removed."""
    return [item for item in items if _is_there(item)]


def unused(items: list) -> list:
    """Return the data-blocks that still exist, are not linked from a library, and have no user.

    The users are searched for: Blender 4.2 counts twice what the nodes of a copied material use.
    """
    items = still_there(items)
    users = bpy.data.user_map(subset=items)
    return [item for item in items if not users[item] and not item.use_fake_user and item.library is None]


def remove_new(item: bpy.types.ID) -> None:
    """Remove newly made data because a later step has failed. Others may have removed it already."""
    bpy.data.batch_remove(still_there([item]))


def _is_there(item: bpy.types.ID) -> bool:
    try:
        return bool(item.name)
    except ReferenceError:
        return False


def keep_object(obj: bpy.types.Object, whole: AllOrNothing) -> None:
    """Let `whole` restore a result's transform, record and materials.

    A library override is an object of this file from then on: Blender takes no entries out of an override's lists.
    """
    if obj.override_library is not None:
        obj.make_local(clear_liboverride=True)
    matrix, place = obj.matrix_world.copy(), {name: tuple(getattr(obj, name)) for name in PLACE}
    record = obj.reflection_mesh
    known = {name: getattr(record, name) for name in RECORD}
    known.update({name: tuple(getattr(record, name)) for name in NUMBERS})
    made_of = [entry.material for entry in record.materials]
    hidden = obj.hide_render, obj.hide_viewport
    lists = [(entries, [entry.object for entry in entries]) for entries in (record.sources, record.parts)]
    slots = [(slot.link, slot.material) for slot in obj.material_slots]

    def back() -> None:
        # the matrix, so that it is right before Blender works it out anew; then the numbers, which it rounds
        obj.matrix_world = matrix
        for name, values in place.items():
            setattr(obj, name, values)
        for name, value in known.items():
            setattr(record, name, value)
        for entries, objects in lists:
            entries.clear()
            for one in objects:
                entries.add().object = one
        obj.hide_render, obj.hide_viewport = hidden
        record.materials.clear()
        for material in made_of:
            record.materials.add().material = material
        for slot, (link, material) in zip(obj.material_slots, slots, strict=False):
            slot.link = link
            if link == "OBJECT":
                slot.material = material
    # states stored later, such as the mesh with its slots, are restored first
    whole.undo(back)


def keep_data(obj: bpy.types.Object, whole: AllOrNothing) -> None:
    """Prepare the mesh of `obj` for writing; afterwards only `obj` uses it."""
    shared = obj.data.users > 1 or obj.data.library is not None
    (_keep_others_mesh if shared else _keep_mesh)(obj, whole)


def _keep_mesh(obj: bpy.types.Object, whole: AllOrNothing) -> None:
    """Prepare the mesh of `obj`, which has no other users, for writing. `whole` restores a copy under its name.

    The copy shares its arrays with the mesh until these are written, and so takes no time and no memory.
    """
    mesh, name = obj.data, obj.data.name
    spare = mesh.copy()

    def back() -> None:
        obj.data = spare
        bpy.data.meshes.remove(mesh)
        spare.name = name
    whole.undo(back)
    whole.after(bpy.data.meshes.remove, spare)


def _keep_others_mesh(obj: bpy.types.Object, whole: AllOrNothing) -> None:
    """Give `obj` a new mesh to write. Other users keep the present one."""
    shared = obj.data
    own = shared.copy()
    whole.undo(bpy.data.meshes.remove, own)
    whole.undo(setattr, obj, "data", shared)
    obj.data = own


def keep_mirror(mirror: bpy.types.Object, whole: AllOrNothing) -> None:
    """Let `whole` restore the camera visibility of a mirror."""
    def back(visible: bool, hidden: bool) -> None:
        mirror.visible_camera, mirror.reflection_mesh.camera_hidden = visible, hidden
    if mirror.library is None:
        whole.undo(back, mirror.visible_camera, mirror.reflection_mesh.camera_hidden)
