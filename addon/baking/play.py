"""Objects that play baked frames with what every Blender has: a Mesh Sequence Cache, nodes, a sequence of pictures."""
from __future__ import annotations

import os
from dataclasses import dataclass

import bpy
import numpy as np

from ..blender_data import compat, forget_nodes, hide_discs, new_object, open_window, results_of, show_own_materials
from ..faults import AllOrNothing, keep_data, keep_mirror, keep_object
from ..lighting import forget_light, new_material
from .frame_records import FrameRecord
from .play_nodes import NAME, unpacking_nodes
from .write_frame import MESH_PATH, OBJECT_PATH

UNPACK = "Reflection Attributes"


@dataclass(frozen=True)
class Sequence:
    """Baked frames of one folder, at least one.

    Attributes
    ----------
    folder : str
        Absolute path.
    records : list of FrameRecord
        In the order of their frames.
    name : str
        What tells it from sequences of other cameras; empty where there are none.
    placement : str
    """

    folder: str
    records: list[FrameRecord]
    name: str
    placement: str


def play(context: bpy.types.Context, mirror: bpy.types.Object, sequence: Sequence, light: bpy.types.Material | None,
         whole: AllOrNothing) -> bpy.types.Object:
    """Let the result of a mirror play a sequence: the one that it has, or a new one.

    Parameters
    ----------
    light : bpy.types.Material or None
        What shows the sequence's light, from `light_of`.
    """
    known = [record.results[mirror.name] for record in sequence.records]
    obj = _object(context, mirror, sequence.name, whole)
    show_own_materials(obj)
    mesh = obj.data
    mesh.clear_geometry()
    mesh.materials.clear()
    materials = sorted({entry for result in known for entry in result.materials})
    for entry in materials or [("", "")]:
        mesh.materials.append(_material(*entry))
    attributes = sorted({entry for result in known for entry in result.attributes})
    cache = _cache(sequence, [result.file for result in known], whole)
    _add_players(obj, cache, unpacking_nodes(attributes, materials), whole)
    record = obj.reflection_mesh
    record.role, record.mirror, record.faces, record.points = "REFLECTION", mirror, 0, 0
    record.sources.clear()
    record.light, record.light_stale = "", False
    earlier, record.light_material = record.light_material, light if any(result.lit for result in known) else None
    if earlier is not None:
        whole.after(forget_light, earlier)
    if record.light_material is not None:
        for slot in obj.material_slots:
            slot.link, slot.material = "OBJECT", light
    keep_mirror(mirror, whole)
    if sequence.placement == "VIRTUAL":
        open_window(mirror)
    return obj


def light_of(sequence: Sequence, whole: AllOrNothing) -> bpy.types.Material | None:
    """A material that shows a sequence's pictures of light, each in its frame; None where there are none."""
    lit = [record for record in sequence.records if record.image]
    if not lit:
        return None
    image = bpy.data.images.load(_path(sequence, lit[0].image))
    whole.undo(_remove, image)
    image.source, image.name = "SEQUENCE", f"Reflection Light {sequence.name}".strip()
    image.colorspace_settings.name = "Non-Color"
    material = new_material(image.name, image, image, np.zeros((1, 1, 3), dtype=np.float32))
    whole.undo(_remove, material)
    tree = material.node_tree
    for node in tree.nodes:
        if node.type == "TEX_IMAGE":
            # of one picture, whose number the keys say: between baked frames the last one stays
            node.image_user.frame_start = node.image_user.frame_duration = 1
            node.image_user.use_auto_refresh = True
            _key(tree, node.image_user, "frame_offset", {record.frame: record.frame - 1 for record in lit})
    return material


def stop_playing(obj: bpy.types.Object) -> None:
    """Take away what makes an object play, where there is anything, so that it shows its own mesh."""
    cache = obj.modifiers.get(NAME)
    if cache is None or cache.type != "MESH_SEQUENCE_CACHE":
        return
    nodes = obj.modifiers.get(UNPACK)
    files, group = cache.cache_file, getattr(nodes, "node_group", None)
    for modifier in (cache, nodes):
        if modifier is not None:
            obj.modifiers.remove(modifier)
    place = obj.constraints.get(NAME)
    if place is not None:
        obj.constraints.remove(place)
    forget_nodes(group)
    if files is not None and not files.users:
        _remove(files)
    light, obj.reflection_mesh.light_material = obj.reflection_mesh.light_material, None
    if light is not None:
        forget_light(light)


def _object(context: bpy.types.Context, mirror: bpy.types.Object, name: str,
            whole: AllOrNothing) -> bpy.types.Object:
    """The result that is to play, which is the mirror's own, or with several sequences the one that is called so."""
    called = f"{mirror.name} Reflection {name}"
    earlier = [obj for obj in results_of(context, mirror) if not name or obj.name == called]
    if not earlier:
        obj = new_object(context, mirror, whole)
        if name:
            obj.name = called
        return obj
    keep_object(earlier[0], whole)
    keep_data(earlier[0], whole)
    whole.undo(stop_playing, earlier[0])
    hide_discs(earlier[0])
    return earlier[0]


def _material(name: str, library: str) -> bpy.types.Material | None:
    """A material of the file by its name; None where it is gone."""
    found = [material for material in bpy.data.materials if material.name == name
             and (material.library.filepath if material.library else "") == library]
    return found[0] if found else None


def _cache(sequence: Sequence, files: list[str], whole: AllOrNothing) -> bpy.types.CacheFile:
    """The files of one result as a sequence whose frames are keyed: between baked frames the last one stays."""
    before = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=os.path.join(sequence.folder, files[0]))
    cache, = set(bpy.data.cache_files) - before
    whole.undo(_remove, cache)
    cache.filepath = _path(sequence, files[0])
    cache.is_sequence = cache.override_frame = True
    _key(cache, cache, "frame", {record.frame: record.frame for record in sequence.records})
    return cache


def _add_players(obj: bpy.types.Object, cache: bpy.types.CacheFile, nodes: bpy.types.NodeTree,
                 whole: AllOrNothing) -> None:
    """The modifiers, before those that the user has added, and the constraint that put `obj` where each frame was."""
    whole.undo(_remove, nodes)
    earlier = [obj.modifiers.get(name) for name in (NAME, UNPACK)]
    reading = earlier[0] or obj.modifiers.new(NAME, "MESH_SEQUENCE_CACHE")
    unpacking = earlier[1] or obj.modifiers.new(UNPACK, "NODES")
    old_cache, old_nodes = reading.cache_file, unpacking.node_group
    reading.cache_file, reading.object_path = cache, MESH_PATH
    reading.read_data = {item.identifier for item in reading.bl_rna.properties["read_data"].enum_items}
    unpacking.node_group = nodes
    for index, modifier in enumerate((reading, unpacking)):
        obj.modifiers.move(list(obj.modifiers).index(modifier), index)
    place = obj.constraints.get(NAME) or obj.constraints.new("TRANSFORM_CACHE")
    place.name, place.cache_file, place.object_path = NAME, cache, OBJECT_PATH
    whole.after(forget_nodes, old_nodes)
    if old_cache is not None:
        whole.after(_forget, old_cache)


def _key(data: bpy.types.ID, holder, name: str, values: dict) -> None:
    """Keys of a value that stays as it is until the next one."""
    for frame, value in values.items():
        setattr(holder, name, value)
        holder.keyframe_insert(name, frame=frame)
    for curve in compat.curves_of(data):
        for key in curve.keyframe_points:
            key.interpolation = "CONSTANT"


def _path(sequence: Sequence, name: str) -> str:
    """The path of a sequence's file, relative to the open file where that can be."""
    path = os.path.join(sequence.folder, name)
    if not bpy.data.filepath:
        return path
    try:
        return bpy.path.relpath(path)
    except ValueError:
        return path     # on another drive


def _remove(data: bpy.types.ID) -> None:
    bpy.data.batch_remove([data])


def _forget(cache: bpy.types.CacheFile) -> None:
    if not cache.users:
        _remove(cache)
