"""Make, update and stop objects that play baked frames without the extension.

They use what every Blender has: a Mesh Sequence Cache modifier, Geometry Nodes for points, and a material that shows
light as an image sequence.
"""
from __future__ import annotations

import os
from dataclasses import dataclass

import bpy

from ..faults import AllOrNothing, keep_data, keep_mirror, keep_object
from ..lighting import forget_light, forget_previews, new_material
from ..mirror_part import Surroundings
from ..reading import Assembly, camera_of, every_result_of, render_size, results_of
from ..writing import (
    forget_nodes,
    hide_discs,
    new_object,
    remember_parts,
    result_name,
    set_window,
    show_own_materials,
)
from .play_nodes import NAME, unpacking_nodes
from .sequence import Sequence, keyed
from .write_frame import MESH_PATH, OBJECT_PATH

UNPACK = "Reflection Attributes"


@dataclass(frozen=True)
class Player:
    """Data for playing the result of one mirror. Everything that can fail has been done.

    Attributes
    ----------
    cache : bpy.types.CacheFile
    nodes : bpy.types.NodeTree
    materials : list of (name, library)
        Materials of the object's slots.
    light : bpy.types.Material or None
    unlit_apart : bool
        True if some frames are lit, and others show `materials` from separate slots.
    """

    joint: Assembly
    sequence: Sequence
    cache: bpy.types.CacheFile
    nodes: bpy.types.NodeTree
    materials: list
    light: bpy.types.Material | None
    unlit_apart: bool

    @property
    def mirror(self) -> bpy.types.Object:
        """The object that the result points to."""
        return self.joint.mirror


def player_of(sequence: Sequence, joint: Assembly, light: bpy.types.Material | None,
              whole: AllOrNothing, key: str = "") -> Player:
    """Read the files of one mirror. Nothing of the user's is changed.

    Parameters
    ----------
    key : str
        Key of its result in the records; empty for the mirror's name.
    light : bpy.types.Material or None
        Material that shows the sequence's light, from `light_of`.
    """
    known = [record.results[key or joint.mirror.name] for record in sequence.records]
    materials = sorted({entry for result in known for entry in result.materials})
    attributes = sorted({entry for result in known for entry in result.attributes})
    lit = light is not None and any(result.lit for result in known)
    apart = lit and not all(result.lit or result.is_empty for result in known)
    nodes = unpacking_nodes(attributes, materials, apart)
    whole.undo(_remove, nodes)
    cache = _cache(sequence, [result.file for result in known], whole)
    return Player(joint, sequence, cache, nodes, materials, light if lit else None, apart)


def play(context: bpy.types.Context, player: Player, sources: list, whole: AllOrNothing) -> bpy.types.Object:
    """Make the result of a mirror play, either its existing one or a new one."""
    mirror = player.mirror
    obj = _object(context, player, whole)
    for part in player.joint.members:
        keep_mirror(part, whole)
    show_own_materials(obj)
    whole.after(forget_previews)
    record = obj.reflection_mesh
    own = [material_of(*entry) for entry in player.materials or [("", "")]]
    show_frames(obj, player, own * (2 if player.unlit_apart else 1), whole)
    record.materials.clear()
    for material in obj.data.materials:
        # else those of the frames, which are in another order, count as the user's when it is generated again
        record.materials.add().material = material
    record.role, record.mirror, record.faces, record.points = "REFLECTION", mirror, 0, 0
    record.resolution = render_size(context.scene)
    remember_parts(record, player.joint)
    record.sources.clear()
    for source in sources:
        record.sources.add().object = source
    record.light = record.lit_from = ""
    earlier, record.light_material = record.light_material, player.light
    if earlier is not None:
        whole.after(forget_light, earlier)
    if player.light is not None:
        for slot in obj.material_slots[:len(own)]:
            slot.link, slot.material = "OBJECT", player.light
    # without one it plays what markers choose, and is right for every camera
    record.camera = context.scene.objects.get(player.sequence.camera) if player.sequence.camera else None
    set_window(obj, player.sequence.placements[mirror.name])
    return obj


def show_frames(obj: bpy.types.Object, player: Player, materials: list, whole: AllOrNothing) -> None:
    """Let an object play instead of showing its own mesh, with these materials in its slots."""
    obj.data.clear_geometry()
    obj.data.materials.clear()
    for material in materials:
        obj.data.materials.append(material)
    _add_modifiers(obj, player, whole)


def plays(obj: bpy.types.Object) -> bool:
    """Return True if an object plays baked frames."""
    cache = obj.modifiers.get(NAME)
    return cache is not None and cache.type == "MESH_SEQUENCE_CACHE"


def light_of(sequence: Sequence, whole: AllOrNothing) -> bpy.types.Material | None:
    """Return a material that shows the images of light of a sequence, frame by frame; None if there are none."""
    lit = [record for record in sequence.records if record.image]
    if not lit:
        return None
    image = bpy.data.images.load(_path(sequence, lit[0].image))
    whole.undo(_remove, image)
    image.source, image.name = "SEQUENCE", f"Reflection Light {sequence.name}".strip()
    image.colorspace_settings.name = "Non-Color"
    behind = Surroundings(behind=set(sequence.placements.values()) != {"VIRTUAL"})
    material = new_material(image.name, image, image, [None], behind, whole)
    tree = material.node_tree
    for node in tree.nodes:
        if node.type == "TEX_IMAGE":
            # a duration of one frame, whose number is keyed: the last baked image stays until the next one
            node.image_user.frame_start = node.image_user.frame_duration = 1
            node.image_user.use_auto_refresh = True
            keyed(tree, node.image_user, "frame_offset",
                  sequence.times({record.frame: record.frame - 1 for record in lit}))
    return material


def stop_playing(obj: bpy.types.Object) -> None:
    """Remove everything that makes an object play, so that it shows its own mesh."""
    if not plays(obj):
        return
    cache, nodes = obj.modifiers[NAME], obj.modifiers.get(UNPACK)
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


def _object(context: bpy.types.Context, player: Player, whole: AllOrNothing) -> bpy.types.Object:
    """Return the result that will play: an existing one of the mirror, which keeps its name if it plays already, or a
    new one.
    """
    mirror, sequence = player.mirror, player.sequence
    called = result_name(mirror, sequence.name)
    earlier = results_to_play(context, player)
    if not earlier:
        others = every_result_of(context, mirror)
        obj = new_object(context, player.joint, whole)
        if sequence.name or (sequence.camera and others):
            # the scene's camera may be another one
            obj.name = result_name(mirror, sequence.name or sequence.camera)
        return obj
    obj = earlier[0]
    keep_object(obj, whole)
    keep_data(obj, whole)
    hide_discs(obj)
    if sequence.name and not plays(obj):
        whole.undo(setattr, obj, "name", obj.name)
        obj.name = called
    return obj


def results_to_play(context: bpy.types.Context, player: Player) -> list:
    """Return the results of a mirror that may play a sequence; the first one will. Prefer the one that plays these
    files, or files of the same name for the same camera. Otherwise return the mirror's own results. With several
    sequences, prefer the result of that name, or a still image for the same camera.
    """
    sequence, every = player.sequence, every_result_of(context, player.mirror)
    called = result_name(player.mirror, sequence.name)
    same = [obj for obj in every if plays(obj) and _goes_on(obj, player)]
    if same or not (sequence.name or sequence.camera):
        return same or results_of(context, player.mirror)
    stills = [obj for obj in every
              if not plays(obj) and sequence.camera in ("", getattr(camera_of(obj), "name", ""))]
    return [obj for obj in every if obj.name == called and sequence.name] or stills


def _goes_on(obj: bpy.types.Object, player: Player) -> bool:
    """Return True if an object plays the files of `player`, or files of the same name in another folder for the same
    camera.
    """
    (folder, name), (own_folder, own_name) = map(_numberless, (player.cache, obj.modifiers[NAME].cache_file))
    return name == own_name and (folder == own_folder
                                 or player.sequence.camera == getattr(camera_of(obj), "name", ""))


def _numberless(cache: bpy.types.CacheFile | None) -> tuple[str, str]:
    """Return the folder of a sequence's files, and their name without the number."""
    if cache is None:
        return "", ""
    folder, name = os.path.split(os.path.abspath(bpy.path.abspath(cache.filepath)))
    return folder, name.rsplit(".", 2)[0]


def material_of(name: str, library: str) -> bpy.types.Material | None:
    """Return a material of the file by its name; None if it is deleted."""
    found = [material for material in bpy.data.materials if material.name == name
             and (material.library.filepath if material.library else "") == library]
    return found[0] if found else None


def _cache(sequence: Sequence, files: list[str], whole: AllOrNothing) -> bpy.types.CacheFile:
    """Return the cache file of one result, with keyed frames. The last baked frame stays until the next one."""
    before = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=os.path.join(sequence.folder, files[0]))
    cache, = set(bpy.data.cache_files) - before
    whole.undo(_remove, cache)
    # it comes with a user that is none, and would never be forgotten
    cache.user_clear()
    cache.filepath = _path(sequence, files[0])
    cache.is_sequence = cache.override_frame = True
    keyed(cache, cache, "frame", sequence.times({record.frame: record.frame for record in sequence.records}))
    return cache


def _add_modifiers(obj: bpy.types.Object, player: Player, whole: AllOrNothing) -> None:
    """Add the modifiers, before the user's, and the constraint that moves `obj` to its place in each frame."""
    earlier = [obj.modifiers.get(name) for name in (NAME, UNPACK)]
    reading = earlier[0] or obj.modifiers.new(NAME, "MESH_SEQUENCE_CACHE")
    unpacking = earlier[1] or obj.modifiers.new(UNPACK, "NODES")
    old_cache, old_nodes = reading.cache_file, unpacking.node_group
    reading.cache_file, reading.object_path = player.cache, MESH_PATH
    reading.read_data = {item.identifier for item in reading.bl_rna.properties["read_data"].enum_items}
    unpacking.node_group = player.nodes
    for index, modifier in enumerate((reading, unpacking)):
        obj.modifiers.move(list(obj.modifiers).index(modifier), index)
    place = obj.constraints.get(NAME) or obj.constraints.new("TRANSFORM_CACHE")
    place.name, place.cache_file, place.object_path = NAME, player.cache, OBJECT_PATH
    whole.after(forget_nodes, old_nodes)
    if old_cache is not None:
        whole.after(_forget, old_cache)


def _path(sequence: Sequence, name: str) -> str:
    """Return the path of a sequence's file, relative to the open file if possible."""
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
