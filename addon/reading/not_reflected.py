"""What mirrors show in renders and no reflection has, where nobody chose to leave it out."""
from __future__ import annotations

import bpy

from .hidden_objects import rendered_in, seen_in
from .materials import all_fog, fog_of
from .mirror_objects import can_take_part

NO_SURFACES = {"CURVES", "POINTCLOUD", "VOLUME"}


def rendered_alone(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """What is hidden in the viewport but not from the mirrors in renders, and so is missing, where all else that is
    seen takes part; nothing where the user chose what does."""
    rendered, taking = rendered_in(context.view_layer), {*mirrors, *diffuse}
    if not _shows_all(context, mirrors, diffuse):
        return []
    return [obj for obj in context.view_layer.objects
            if obj not in taking and obj.visible_glossy and can_take_part(obj) and rendered(obj)]


def in_background_set(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """What renders show of the scenes behind this one, where all that is seen in this one takes part."""
    found: list = []
    behind = context.scene.background_set
    while behind is not None and _shows_all(context, mirrors, diffuse):
        found += [obj for obj in behind.objects if can_take_part(obj) and obj.visible_glossy and not obj.hide_render]
        behind = behind.background_set
    return found


def _shows_all(context: bpy.types.Context, mirrors: list, diffuse: list) -> bool:
    """Whether all that is seen takes part, and nothing was left out by choice."""
    is_seen, taking = seen_in(context), {*mirrors, *diffuse}
    return not any(obj not in taking and obj.visible_glossy and can_take_part(obj) and is_seen(obj)
                   for obj in context.view_layer.objects)


def without_surface(context: bpy.types.Context, mirrors: list, diffuse: list) -> list:
    """What mirrors would show in renders but no mesh can be read of: of diffuse objects, of what is selected with them,
    and where all that is seen takes part."""
    is_seen, everything = seen_in(context), _shows_all(context, mirrors, diffuse)
    drawn = _drawn_without(context.evaluated_depsgraph_get())
    return [obj for obj in context.view_layer.objects
            if (obj in drawn or _has_hair(obj) or all_fog(obj)) and obj.visible_glossy and is_seen(obj)
            and (obj in diffuse or not can_take_part(obj) and (everything or obj.select_get()))]


def has_fog(scene: bpy.types.Scene) -> bool:
    """Whether the world of a scene, or an object that renders show, is fog."""
    return fog_of(scene.world) is not None or any(all_fog(obj) and not obj.hide_render for obj in scene.objects)


def _drawn_without(depsgraph: bpy.types.Depsgraph) -> set:
    """The objects that are, or of which nodes or instances make, what has no mesh."""
    found = set()
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        if evaluated.type in NO_SURFACES and _is_anything(evaluated):
            found.add(instance.parent.original if instance.is_instance else evaluated.original)
    return found


def _is_anything(evaluated: bpy.types.Object) -> bool:
    """Whether there is anything in curves, a cloud or a volume: nodes may have left nothing."""
    data = evaluated.data
    if evaluated.type == "VOLUME":
        return len(data.grids) > 0 or not any(modifier.type == "NODES" for modifier in evaluated.modifiers)
    return len(data.curves if evaluated.type == "CURVES" else data.points) > 0


def _has_hair(obj: bpy.types.Object) -> bool:
    """Whether renders show hair of particles on an object."""
    return any(modifier.show_render and modifier.particle_system.settings.type == "HAIR"
               and modifier.particle_system.settings.render_type == "PATH"
               for modifier in obj.modifiers if modifier.type == "PARTICLE_SYSTEM")
