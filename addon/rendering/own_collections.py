"""Temporary scenes that show the user's objects otherwise, without a change to these: by collections of their own.

An object's own flags hold in every scene, and the user's viewport would show what is changed of them. Flags of
collections hold in the view layer of one scene alone (Blender's *Holdout* and *Indirect Only*).
"""
from __future__ import annotations

from collections.abc import Iterable
from contextlib import ExitStack

import bpy

from ..faults import still_there
from ..reading import rendered_in

NAME = "Reflection Scene"
Kind = tuple[bool, bool]


class OwnCollections:
    """The objects of a temporary scene, in one collection for each kind: whether they are held out, and indirect only.

    Parameters
    ----------
    scene : bpy.types.Scene
        A copy of the context's, with its view layer alone.
    back : ExitStack
        Removes the collections and the copies.
    """

    def __init__(self, context: bpy.types.Context, scene: bpy.types.Scene, back: ExitStack) -> None:
        self._scene, self._layer = scene, scene.view_layers[0]
        self._groups: dict[Kind | None, bpy.types.Collection] = {}
        self._kinds: dict[bpy.types.Object, Kind | None] = {}
        self._copies: list[bpy.types.Object] = []
        back.callback(self._remove)
        layer, root = context.view_layer, scene.collection
        rendered = rendered_in(layer)
        kinds = {obj: (obj.holdout_get(view_layer=layer), obj.indirect_only_get(view_layer=layer)) if rendered(obj)
                 else None for obj in layer.objects}
        for child in list(root.children):
            root.children.unlink(child)
        for obj in list(root.objects):
            root.objects.unlink(obj)
        for obj, kind in kinds.items():
            self._put(obj, kind)

    @property
    def shown(self) -> list:
        """The objects that renders show."""
        return [obj for obj, kind in self._kinds.items() if kind is not None]

    @property
    def seen(self) -> list:
        """The rendered objects without those that are held out and indirect only, which the camera does not see."""
        return [obj for obj in self.shown if self._kinds[obj][0] or not self._kinds[obj][1]]

    def hold_out(self, objects: Iterable[bpy.types.Object]) -> None:
        """Let objects be holes in the picture."""
        self._change(objects, lambda kind: (True, kind[1]))

    def hide_from_camera(self, objects: Iterable[bpy.types.Object]) -> None:
        """Let the camera not see objects, and all else see them; of lamps, which collections do not hide, copies."""
        objects = list(objects)
        lamps = [obj for obj in objects if obj.type == "LIGHT"]
        for lamp in filter(lambda lamp: lamp.visible_camera, lamps):
            self.copy_of(lamp).visible_camera = False
        self._change((obj for obj in objects if obj.type != "LIGHT"), lambda kind: (kind[0], True))

    def leave_out(self, objects: Iterable[bpy.types.Object]) -> None:
        """Let renders not show objects, which others may still depend on."""
        self._change(objects, lambda kind: None)

    def remove(self, objects: Iterable[bpy.types.Object]) -> None:
        """Let objects not be in the scene at all."""
        for obj in objects:
            self._groups[self._kinds.pop(obj)].objects.unlink(obj)

    def copy_of(self, obj: bpy.types.Object) -> bpy.types.Object:
        """Return a copy that stands in for an object, and may be changed."""
        copy = obj.copy()
        self._copies.append(copy)
        kind = self._kinds[obj]
        self.leave_out([obj])
        self._put(copy, kind)
        return copy

    def _change(self, objects: Iterable[bpy.types.Object], changed) -> None:
        for obj in list(objects):
            kind = self._kinds.get(obj)
            if kind is not None and changed(kind) != kind:
                self._groups[kind].objects.unlink(obj)
                self._put(obj, changed(kind))

    def _put(self, obj: bpy.types.Object, kind: Kind | None) -> None:
        if kind not in self._groups:
            self._groups[kind] = group = bpy.data.collections.new(NAME)
            self._scene.collection.children.link(group)
            branch = self._layer.layer_collection.children[group.name]
            if kind is None:
                group.hide_render = True
            else:
                branch.holdout, branch.indirect_only = kind
        self._groups[kind].objects.link(obj)
        self._kinds[obj] = kind

    def _remove(self) -> None:
        bpy.data.batch_remove([*still_there(self._copies), *still_there(list(self._groups.values()))])
