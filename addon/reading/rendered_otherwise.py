"""What renders show with another mesh than viewports do: of that a reflection shows the viewport's, as all of Blender's
tools do that read meshes."""
from __future__ import annotations

import bpy

from ..compat import dices
from .metaballs import is_part

LEVELS = (("levels", "render_levels"), ("steps", "render_steps"))
RESOLUTIONS = (("resolution_u", "render_resolution_u"), ("resolution_v", "render_resolution_v"))


def rendered_otherwise(scene: bpy.types.Scene, obj: bpy.types.Object) -> str:
    """The name of the first modifier of an object, or of the curve or metaball that it shows, by which renders of the
    scene give it another mesh than viewports; empty where there is none."""
    for modifier in obj.modifiers:
        if modifier.show_viewport != modifier.show_render or (modifier.show_render and _finer(scene, modifier)):
            return modifier.name
    if dices(scene, obj):
        return obj.modifiers[-1].name
    data = obj.data
    if obj.type == "META" and not is_part(obj) and data.resolution != data.render_resolution:
        return data.name
    # none of its own: renders take the viewport's
    if obj.type in {"CURVE", "SURFACE", "FONT"} and any(
            getattr(data, render) not in {0, getattr(data, view)} for view, render in RESOLUTIONS):
        return data.name
    return ""


def _finer(scene: bpy.types.Scene, modifier: bpy.types.Modifier) -> bool:
    if modifier.type == "PARTICLE_SYSTEM":
        settings = modifier.particle_system.settings
        return settings.render_type in {"OBJECT", "COLLECTION"} and settings.display_percentage < 100
    most = (scene.render.simplify_subdivision, scene.render.simplify_subdivision_render)
    simplified = scene.render.use_simplify and modifier.type in {"SUBSURF", "MULTIRES"}
    for names in LEVELS:
        if all(hasattr(modifier, name) for name in names):
            view, render = (getattr(modifier, name) for name in names)
            return (min(view, most[0]) != min(render, most[1])) if simplified else view != render
    return False
