"""Who holds settings: a scene, and each mirror that has its own; operators, whose options stand above both."""
from __future__ import annotations

import bpy

from .declared import LIGHT_SETTINGS, SETTINGS, WRITTEN_SETTINGS, declared

ALL = SETTINGS + LIGHT_SETTINGS + WRITTEN_SETTINGS


class SettingsOptions:
    """Mix-in: the settings of a reflection as options of an operator."""

    __annotations__ = declared(SETTINGS, options={"SKIP_SAVE"})


class SettingsOfScene:
    """Mix-in of the scene's settings, which hold for every mirror that has none of its own."""

    __annotations__ = declared(ALL)


class SettingsOfMirror:
    """Mix-in of the settings of one mirror, in use where its `own_settings` says so.

    They stand beside the role, in no group of their own: Blender 5 loses overrides of a group inside a group that the
    linked file does not hold.
    """

    __annotations__ = declared(ALL, override={"LIBRARY_OVERRIDABLE"})


def mirror_of(obj: bpy.types.Object | None) -> bpy.types.Object | None:
    """Return the mirror whose settings apply to an object: the mirror of a result, or the object itself."""
    if obj is not None and obj.reflection_mesh.role in {"REFLECTION", "CAUSTICS"}:
        return obj.reflection_mesh.mirror
    return obj


def holder_of(mirror: bpy.types.Object | None, scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """Return the property group with the settings of a mirror: its own if it has any, else the scene's."""
    if mirror is not None and mirror.reflection_mesh.own_settings:
        return mirror.reflection_mesh
    return scene.reflection_mesh


def make_own(mirror: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Copy the scene's settings to a mirror when it gets its own for the first time."""
    record = mirror.reflection_mesh
    if not any(map(record.is_property_set, ALL)):
        for name in ALL:
            setattr(record, name, getattr(scene.reflection_mesh, name))
