"""Find objects that mirrors show in renders but that no reflection contains, though the user did not exclude them."""
from __future__ import annotations

import bpy

from .hidden_objects import rendered_in, seen_in
from .materials import all_fog, fog_of
from .mirror_objects import can_take_part

NO_SURFACES = {"CURVES", "POINTCLOUD", "VOLUME"}


def rendered_alone(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """Return the objects that are hidden in the viewport but that mirrors show in renders. Return an empty list if the
    user chose what takes part, that is, if a visible object is left out.
    """
    rendered, taking = rendered_in(context.view_layer), {*mirrors, *diffuse}
    if not _shows_all(context, mirrors, diffuse):
        return []
    return [obj for obj in context.view_layer.objects
            if obj not in taking and obj.visible_glossy and can_take_part(obj) and rendered(obj)]


def in_background_set(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """Return the objects that renders show from the background sets of this scene. Return an empty list if a visible
    object of this scene is left out.
    """
    found: list = []
    behind = context.scene.background_set
    while behind is not None and _shows_all(context, mirrors, diffuse):
        found += [obj for obj in behind.objects if can_take_part(obj) and obj.visible_glossy and not obj.hide_render]
        behind = behind.background_set
    return found


def _shows_all(context: bpy.types.Context, mirrors: list, diffuse: list) -> bool:
    """Return True if every visible object takes part as a mirror or as a diffuse object."""
    is_seen, taking = seen_in(context), {*mirrors, *diffuse}
    return not any(obj not in taking and obj.visible_glossy and can_take_part(obj) and is_seen(obj)
                   for obj in context.view_layer.objects)


def without_surface(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """Return the objects that mirrors show in renders but that have no mesh, such as hair, curves and volumes. They
    must be diffuse or selected, unless every visible object takes part.
    """
    is_seen, everything = seen_in(context), _shows_all(context, mirrors, diffuse)
    drawn = _drawn_without(context.evaluated_depsgraph_get())
    return [obj for obj in context.view_layer.objects
            if (obj in drawn or _has_hair(obj) or all_fog(obj)) and obj.visible_glossy and is_seen(obj)
            and (obj in diffuse or not can_take_part(obj) and (everything or obj.select_get()))]


def has_fog(scene: bpy.types.Scene) -> bool:
    """Return True if the world of a scene, or an object that renders show, has only a volume."""
    return fog_of(scene.world) is not None or any(all_fog(obj) and not obj.hide_render for obj in scene.objects)


def _drawn_without(depsgraph: bpy.types.Depsgraph) -> set:
    """Return the objects that have no mesh themselves, or whose nodes or instances make data without a mesh."""
    found = set()
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        if evaluated.type in NO_SURFACES and _is_anything(evaluated):
            found.add(instance.parent.original if instance.is_instance else evaluated.original)
    return found


def _is_anything(evaluated: bpy.types.Object) -> bool:
    """Return True if curves, a point cloud or a volume are not empty, as nodes may have left them."""
    data = evaluated.data
    if evaluated.type == "VOLUME":
        return len(data.grids) > 0 or not any(modifier.type == "NODES" for modifier in evaluated.modifiers)
    return len(data.curves if evaluated.type == "CURVES" else data.points) > 0


def _has_hair(obj: bpy.types.Object) -> bool:
    """Return True if renders show particle hair on an object."""
    return any(modifier.show_render and modifier.particle_system.settings.type == "HAIR"
               and modifier.particle_system.settings.render_type == "PATH"
               for modifier in obj.modifiers if modifier.type == "PARTICLE_SYSTEM")
