"""Link new objects into the collections of the objects that they belong to."""
from __future__ import annotations

import bpy

from ..reading import redraw_lines


def link_beside(scene: bpy.types.Scene, obj: bpy.types.Object, other: bpy.types.Object) -> None:
    """Link `obj` into the editable collections of `other` in this scene, else into the scene's own collection. Linked
    collections and library overrides are not editable.
    """
    of_scene = {scene.collection, *scene.collection.children_recursive}
    beside = [collection for collection in other.users_collection
              if collection in of_scene and collection.library is None and collection.override_library is None]
    for collection in beside or [scene.collection]:
        collection.objects.link(obj)
    redraw_lines(scene)
