"""What mirrors show in renders and no reflection has, where nobody chose to leave it out."""
from __future__ import annotations

import bpy

from .roles import can_take_part, rendered_in, seen_in

NO_SURFACES = {"CURVES", "POINTCLOUD", "VOLUME"}


def rendered_alone(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """What is hidden in the viewport but not from the mirrors in renders, and so is missing, where all else that is
    seen takes part; nothing where the user chose what does."""
    rendered, taking = rendered_in(context), {*mirrors, *diffuse}
    if not _shows_all(context, mirrors, diffuse):
        return []
    return [obj for obj in context.view_layer.objects
            if obj not in taking and obj.visible_glossy and can_take_part(obj) and rendered(obj)]


def _shows_all(context: bpy.types.Context, mirrors: list, diffuse: list) -> bool:
    """Whether all that is seen takes part, and nothing was left out by choice."""
    is_seen, taking = seen_in(context), {*mirrors, *diffuse}
    return not any(obj not in taking and obj.visible_glossy and can_take_part(obj) and is_seen(obj)
                   for obj in context.view_layer.objects)


def without_surface(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """What mirrors would show in renders but no mesh can be read of: of diffuse objects, of what is selected with them,
    and where all that is seen takes part."""
    is_seen, everything = seen_in(context), _shows_all(context, mirrors, diffuse)
    return [obj for obj in context.view_layer.objects if _no_surface(obj) and obj.visible_glossy and is_seen(obj) and (
        obj in diffuse or not can_take_part(obj) and (everything or obj.select_get()))]


def _no_surface(obj: bpy.types.Object) -> bool:
    """Whether renders show an object, or hair on it, of which no mesh can be read."""
    return obj.type in NO_SURFACES or any(
        modifier.show_render and modifier.particle_system.settings.type == "HAIR"
        and modifier.particle_system.settings.render_type == "PATH"
        for modifier in obj.modifiers if modifier.type == "PARTICLE_SYSTEM")
