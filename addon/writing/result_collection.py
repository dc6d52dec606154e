"""The collection in which results made in a window lie together, and its end when nothing lies in it any more."""
from __future__ import annotations

import bpy

from ..faults import AllOrNothing
from ..reading import mirrors_of, rendered_collections

NAME = "Reflections"
LAYER = "reflection_mesh_layer"  # custom property of the collections that one view layer alone shows


def gather(context: bpy.types.Context, objects: list, whole: AllOrNothing) -> None:
    """Move new results, which nothing else in the file knows yet, into the scene's collection of results; they stay
    where they are where that is hidden, and where their mirror is held out or seen by indirect rays alone, as they then
    are too."""
    scene, layer = context.scene, context.view_layer
    mirrors = {obj: mirrors_of(obj)[0] for obj in objects}
    objects = [obj for obj, mirror in mirrors.items()
               if not (mirror.holdout_get(view_layer=layer) or mirror.indirect_only_get(view_layer=layer))]
    if not objects:
        return
    target = _own(scene) or scene.collection.children.get(NAME) or _new(scene, whole)
    if target.library or target.override_library or target not in rendered_collections(layer.layer_collection):
        return
    for obj in objects:
        for other in list(obj.users_collection):
            other.objects.unlink(obj)
        target.objects.link(obj)


def show_in_layer(scene: bpy.types.Scene, layer: bpy.types.ViewLayer, objects: list) -> None:
    """Let one view layer show results, and no other."""
    made = next((other for other in scene.collection.children if other.get(LAYER) == layer.name), None)
    if made is None:
        made = bpy.data.collections.new(f"{NAME} {layer.name}")
        made[LAYER] = layer.name
        scene.collection.children.link(made)
    for obj in objects:
        for other in list(obj.users_collection):
            other.objects.unlink(obj)
        made.objects.link(obj)
    for other in scene.view_layers:
        other.layer_collection.children[made.name].exclude = other != layer


def forget_collection(scene: bpy.types.Scene) -> None:
    """Remove the scene's collections of results where they were made for them and are empty."""
    for made in [_own(scene), *(other for other in scene.collection.children if LAYER in other)]:
        if made is not None and made.library is None and not made.objects and not made.children:
            bpy.data.collections.remove(made)


def _own(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    """Return the collection that was made for the results of this scene, if the scene still has it."""
    made = scene.reflection_mesh.collection
    return made if made is not None and made in scene.collection.children_recursive else None


def _new(scene: bpy.types.Scene, whole: AllOrNothing) -> bpy.types.Collection:
    made = bpy.data.collections.new(NAME)
    whole.undo(bpy.data.collections.remove, made)
    scene.collection.children.link(made)
    scene.reflection_mesh.collection = made
    return made
