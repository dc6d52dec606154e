"""Cycles' own caustics of a lamp in a mirror, left out where the mesh shows them: light linking, for this pair alone.

The mirror is taken out of what the lamp lights, so that no ray finds the lamp in it. It goes on to shade, to reflect
everything else, and to be lit by all other lamps. The lamp's own image in the mirror, which goes with it, is brought
back by a second lamp, or a shell that shines.
"""
from __future__ import annotations

from contextlib import ExitStack

import bpy

from ... import compat
from ...faults import AllOrNothing
from ...reading import is_mirror, link_state
from ...reading.materials import MIRRORS, all_nodes, is_sharp, surface_shaders
from ..mirrors import has_mirrors
from .glint import forget_lost_glints, glint_of, hide_from_mirror, show_in_mirror


def makes_own_caustics(materials: list) -> tuple[bool, bool]:
    """Return True if Cycles finds lamps in a mirror with these materials, and True if the materials only reflect. A
    surface that is lit as well, such as water over its ground, cannot be excluded from a lamp's light.
    """
    whole = [is_mirror(material) for material in materials]
    sharp = (node for material in materials if compat.uses_nodes(material) for node in all_nodes(material.node_tree)
             if node.type in {*MIRRORS, "BSDF_PRINCIPLED", "BSDF_GLASS"})
    alone = (mirroring or _mirrors_alone(material) for mirroring, material in zip(whole, materials))
    own = any(whole) or any(map(is_sharp, sharp)) or any(map(has_mirrors, materials))
    return own, bool(whole) and all(alone)


def _mirrors_alone(material: bpy.types.Material | None) -> bool:
    """Return True if a material consists only of shaders that light does not enter."""
    shaders = surface_shaders(material.node_tree) if material is not None and compat.uses_nodes(material) else []
    return bool(shaders) and all(shader.type in MIRRORS for shader in shaders)


def leave_out_own_caustics(scene: bpy.types.Scene, lamp: bpy.types.Object, mirror: bpy.types.Object,
                           whole: AllOrNothing) -> bool:
    """Exclude a mirror from a lamp's light, unless the user has done so already. The mirror still shows the lamp.
    Return False, without changes, if the user has linked the lamp otherwise or the lamp belongs to another file.
    """
    linking = lamp.light_linking
    collection = linking.receiver_collection
    if collection is not None and not collection.get(_MARK) and not _lit_by(collection, mirror):
        return True
    if lamp.library is not None or (collection is not None and not _is_ours(collection, lamp)):
        return False
    if collection is None:
        collection = bpy.data.collections.new(_name(lamp))
        collection[_MARK] = True
        whole.undo(bpy.data.collections.remove, collection)
        linking.receiver_collection = collection
    if mirror.name not in collection.objects:
        collection.objects.link(mirror)
        whole.undo(collection.objects.unlink, mirror)
    for entry, child in zip(collection.collection_objects, collection.objects):
        if child == mirror:
            entry.light_linking.link_state = "EXCLUDE"
    show_in_mirror(scene, lamp, mirror, whole)
    return True


def bring_back_own_caustics(lamp: bpy.types.Object | None, mirror: bpy.types.Object | None) -> None:
    """Let a lamp light a mirror again."""
    collection = None if lamp is None else lamp.light_linking.receiver_collection
    if collection is None or not _is_ours(collection, lamp):
        return
    hide_from_mirror(lamp, mirror)
    if mirror is not None and mirror.name in collection.objects:
        collection.objects.unlink(mirror)
    if not len(collection.objects):
        bpy.data.collections.remove(collection)


def bring_back_abandoned() -> bool:
    """Restore all lamps and mirrors whose caustics are no longer shown by a mesh, whatever removed it, see
    `bring_back_own_caustics`. Return True if there were any.
    """
    # deleted objects that are still referenced exist without a scene
    made = {(obj.reflection_mesh.lamp, obj.reflection_mesh.mirror) for scene in bpy.data.scenes
            for obj in scene.objects if obj.reflection_mesh.role == "CAUSTICS"}
    lamps: dict = {}
    for lamp in bpy.data.objects:
        collection = lamp.light_linking.receiver_collection
        if collection is not None and _is_ours(collection, lamp):
            # a copy of a lamp shares it
            lamps.setdefault(collection, []).append(lamp)
    abandoned = [(own[0], mirror) for collection, own in lamps.items() for mirror in [*collection.objects] or [None]
                 if not any((lamp, mirror) in made for lamp in own)]
    for pair in abandoned:
        bring_back_own_caustics(*pair)
    lost = [collection for collection in bpy.data.collections if collection.get(_MARK) and not collection.users]
    for collection in lost:
        bpy.data.collections.remove(collection)
    return any((abandoned, lost, forget_lost_glints(_leaves_out_some)))


def leaves_out_any() -> bool:
    """Return True if a mirror of the file is excluded, judging by collections only: cheap, without a search for lamps.
    """
    return any(_MARK in collection and collection.library is None for collection in bpy.data.collections)


def leaves_out(lamp: bpy.types.Object, mirror: bpy.types.Object) -> bool:
    """Return True if a lamp does not light a mirror because a mesh shows its caustics."""
    collection = lamp.light_linking.receiver_collection
    return collection is not None and _is_ours(collection, lamp) and mirror.name in collection.objects


def is_shown_in(lamp: bpy.types.Object, mirror: bpy.types.Object) -> bool:
    """Return True if a mirror shows a lamp: one that is linked to it, or would be but for its caustics."""
    collection = lamp.light_linking.receiver_collection
    return collection is None or _is_ours(collection, lamp) or _lit_by(collection, mirror)


def let_lamps_light_mirrors(lamps: list, back: ExitStack) -> None:
    """Let lamps light the mirrors from which they are excluded, until the stack is closed."""
    for lamp in dict.fromkeys(lamps):
        if _leaves_out_some(lamp):
            back.callback(setattr, lamp.light_linking, "receiver_collection", lamp.light_linking.receiver_collection)
            lamp.light_linking.receiver_collection = None
            glint = glint_of(lamp)
            if glint is not None:
                back.callback(setattr, glint, "hide_render", glint.hide_render)
                glint.hide_render = True


def _leaves_out_some(lamp: bpy.types.Object) -> bool:
    collection = lamp.light_linking.receiver_collection
    return collection is not None and _is_ours(collection, lamp)


def _lit_by(collection: bpy.types.Collection, obj: bpy.types.Object) -> bool:
    """Return True if a lamp linked to a collection lights an object. Excluded objects are not lit; if anything is
    included, nothing else is lit.
    """
    told = link_state(collection, obj)
    if told is not None:
        return told == "INCLUDE"
    return all(entry.light_linking.link_state == "EXCLUDE"
               for entry in (*collection.collection_children, *collection.collection_objects))


_MARK = "reflection_mesh_left_out"


def _name(lamp: bpy.types.Object) -> str:
    return f"{lamp.name} Caustics Left Out"


def _is_ours(collection: bpy.types.Collection, lamp: bpy.types.Object) -> bool:
    return bool(collection.get(_MARK)) and collection.library is None
