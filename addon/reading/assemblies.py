"""Mirrors of several parts: the mirrors of one object hierarchy, as importers make them, have one result together."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy

from .results import is_result, mirrors_of


@dataclass(frozen=True)
class Assembly:
    """A mirror with one result.

    Attributes
    ----------
    mirror : bpy.types.Object
        The object that the result points to: the only part, or the root of the hierarchy.
    parts : list of bpy.types.Object
        The objects that reflect.
    members : list of bpy.types.Object
        The parts, and those that are hidden at the moment.
    """

    mirror: bpy.types.Object
    parts: list
    members: list

    @classmethod
    def of(cls, mirror: bpy.types.Object) -> Assembly:
        """Return a mirror of one part."""
        return cls(mirror, [mirror], [mirror])

    @property
    def is_joined(self) -> bool:
        """Return True if the result has to remember the parts."""
        return self.members != [self.mirror]

    def among(self, mirrors: list) -> Assembly:
        """Return the same assembly, of which only the parts among `mirrors` reflect."""
        return replace(self, parts=[part for part in self.parts if part in mirrors])


def assemblies(context: bpy.types.Context, mirrors: list, joins: Callable[[bpy.types.Object], bool]) -> list[Assembly]:
    """Group mirrors by their results.

    Existing results keep their parts. Mirrors without a result are grouped by the root of their hierarchy if `joins`
    is true for them; a new part of a hierarchy that has a joined result is added to it.
    """
    results = [obj for obj in context.scene.objects if is_result(obj) and obj.reflection_mesh.mirror is not None]
    owner, members = {}, {}
    for result in results:
        pointer = result.reflection_mesh.mirror
        for part in mirrors_of(result):
            owner.setdefault(part, pointer)
            members.setdefault(pointer, {})[part] = None
    joined = {result.reflection_mesh.mirror for result in results if len(result.reflection_mesh.parts)}
    groups: dict = {}
    for mirror in mirrors:
        if mirror in owner:
            key = owner[mirror], None
        elif not joins(mirror):
            key = mirror, None
        else:
            key = (root_of(mirror), None) if root_of(mirror) in joined else (root_of(mirror), _traits(context, mirror))
        groups.setdefault(key, []).append(mirror)
    taken, made = set(owner.values()), []
    for (pointer, traits), parts in groups.items():
        if traits is not None:
            pointer = _pointer(context, pointer, parts, {*taken, *mirrors} - {*parts})
        taken.add(pointer)
        made.append(Assembly(pointer, parts, list(dict.fromkeys([*members.get(pointer, ()), *parts]))))
    return made


def root_of(obj: bpy.types.Object) -> bpy.types.Object:
    """Return the topmost parent of an object."""
    while obj.parent is not None:
        obj = obj.parent
    return obj


def _pointer(context: bpy.types.Context, root: bpy.types.Object, parts: list, taken: set) -> bpy.types.Object:
    """Return the object that names a group of mirrors: its root, unless that is not in the scene or has a result of
    its own."""
    usable = context.view_layer.objects.get(root.name) == root and root not in taken
    return root if len(parts) > 1 and usable else parts[0]


def _traits(context: bpy.types.Context, mirror: bpy.types.Object) -> tuple:
    """Return what all parts of one result have in common, because it is set for the whole object."""
    layer, record = context.view_layer, mirror.reflection_mesh
    return (mirror.is_holdout, mirror.holdout_get(view_layer=layer), mirror.indirect_only_get(view_layer=layer),
            mirror.is_shadow_catcher, mirror.visible_camera or record.camera_hidden, mirror.library)
