"""Find objects whose mesh differs between viewports and renders. Reflections show the viewport's mesh, as do all tools
of Blender that read meshes.
"""
from __future__ import annotations

import bpy

from ..compat import dices
from .metaballs import is_part

LEVELS = (("levels", "render_levels"), ("steps", "render_steps"))
RESOLUTIONS = (("resolution_u", "render_resolution_u"), ("resolution_v", "render_resolution_v"))


def rendered_otherwise(scene: bpy.types.Scene, obj: bpy.types.Object) -> str:
    """Return the name of the first modifier, or of the curve or metaball data, that gives an object another mesh in
    renders than in viewports; empty if there is none.
    """
    for modifier in obj.modifiers:
        if modifier.show_viewport != modifier.show_render or (modifier.show_render and _finer(scene, modifier)):
            return modifier.name
    if dices(scene, obj):
        return obj.modifiers[-1].name
    data = obj.data
    if obj.type == "META" and not is_part(obj) and data.resolution != data.render_resolution:
        return data.name
    # a render resolution of 0 means the viewport's
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
