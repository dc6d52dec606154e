"""The one sentence that the panel tells about the scene's results: what to do next, or that nothing is to be done."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import bpy
from bpy.app.translations import pgettext_iface

from ..faults import translated
from ..frames import plays
from ..freshness import why_light_differs, why_light_is_stale, why_stale
from ..lighting import is_lit, light_sentence
from ..live import abandoned_light, abandoned_results, kept_light, kept_results, present
from ..operators.polls import has_mirror
from ..reading import RESULTS, can_take_part, is_gone, is_result, known_results, result_of

# without their materials' light
PLAIN_SHADING = {"SOLID", "WIREFRAME"}


@dataclass(frozen=True)
class Prompt:
    """A sentence in the user's language, its icon, and what draws a button under it, if it has one."""

    text: str
    icon: str = "INFO"
    button: Callable[[bpy.types.UILayout], None] | None = None


def prompt(context: bpy.types.Context, obj: bpy.types.Object | None) -> Prompt:
    """Return what matters most at the moment; `obj` is the active object."""
    return next(filter(None, (one(context, obj) for one in PROMPTS)), Prompt(""))


def longest(context: bpy.types.Context) -> tuple[Prompt, ...]:
    """Return the longest of the usual prompts, without and with a button: the panel keeps room for them."""
    return (Prompt(pgettext_iface("The scene has changed since the reflection was lit. Click Light Reflection.")),
            shading_prompt("Wireframe", True, True),
            replace(missing_mirror_prompt(None), button=_draw_material_preview))


def _live(_context: bpy.types.Context, _obj: bpy.types.Object | None) -> Prompt | None:
    updater = present()
    return None if updater is None else Prompt(state_of(updater), "TIME")


def state_of(updater) -> str:
    """Return in a few words what Live is doing."""
    if updater.told:
        return translated(pgettext_iface(updater.told))
    text = pgettext_iface("Exact, {milliseconds:.0f} ms" if updater.at_rest else "Coarse, {milliseconds:.0f} ms")
    return text.format(milliseconds=updater.milliseconds)


def _broken(_context: bpy.types.Context, obj: bpy.types.Object | None) -> Prompt | None:
    """Return a prompt for a result that cannot be updated, else None: converted, linked, or without its mirror or lamp.
    """
    if obj is None or obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}:
        return None
    record = obj.reflection_mesh
    if obj.library is not None:
        return Prompt(pgettext_iface("This result is linked from another file. Update and light it there."), "LINKED")
    if is_gone(record.mirror) or (record.role == "CAUSTICS" and is_gone(record.lamp)):
        return Prompt(pgettext_iface("Its mirror or its lamp is gone. Click Clear Reflections."), "ERROR")
    if obj.type != "MESH":
        # Object > Convert
        return Prompt(pgettext_iface("This reflection is not a mesh any more. Click Generate Reflection."), "ERROR")
    return None


def _stale(context: bpy.types.Context, _obj: bpy.types.Object | None) -> Prompt | None:
    gone = abandoned_results(context) + abandoned_light(context)
    whys = [why for one in kept_results(context) if (why := _why(context, one))]
    whys += [why for one in kept_light(context) if one not in gone and (why := why_light_is_stale(context, one))]
    if whys:
        text = pgettext_iface("1 result is out of date: {why}. Click Update Reflections." if len(whys) == 1 else
                              "{count} results are out of date: {why}. Click Update Reflections.")
        return Prompt(text.format(count=len(whys), why=pgettext_iface(whys[0])), "ERROR")
    if gone:
        text = pgettext_iface("The mirror or the lamp of '{name}' is gone. Select it in the Outliner and click Clear "
                              "Reflections.")
        return Prompt(text.format(name=gone[0].name), "ERROR")
    return None


def _why(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return why a reflection, or else its light, is no longer right; empty if both are."""
    return why_stale(context, result) or (why_light_differs(context, result) if is_lit(result) else "")


def _shading(context: bpy.types.Context, _obj: bpy.types.Object | None) -> Prompt | None:
    """Return a prompt for a 3D viewport that shows results differently from renders, else None. The Properties editor
    has none.
    """
    space = getattr(context, "space_data", None)
    if space is None or space.type != "VIEW_3D":
        return None
    kind, workbench = space.shading.type, context.scene.render.engine == "BLENDER_WORKBENCH"
    if kind not in PLAIN_SHADING and not (kind == "RENDERED" and workbench):
        return None
    shown = [one for one in known_results(context.scene, context.view_layer) if one.visible_get()]
    if not shown:
        return None
    name = pgettext_iface(space.shading.bl_rna.properties["type"].enum_items[kind].name)
    reflections = any(map(is_result, shown))
    return shading_prompt("Workbench" if kind == "RENDERED" else name, reflections,
                          not all(map(is_result, shown)))


def shading_prompt(shading: str, reflections: bool, caustics: bool) -> Prompt:
    """Return the prompt for a viewport whose shading shows results without their light."""
    if reflections and caustics:
        text = pgettext_iface("{shading} shading shows no caustics, and no light in reflections.")
    elif reflections:
        text = pgettext_iface("{shading} shading shows reflections without light and textures.")
    else:
        text = pgettext_iface("{shading} shading does not show caustics.")
    return Prompt(text.format(shading=shading), "SHADING_SOLID", _draw_material_preview)


def _draw_material_preview(layout: bpy.types.UILayout) -> None:
    button = layout.operator("wm.context_set_enum", text="Material Preview", icon="SHADING_TEXTURE")
    button.data_path, button.value = "space_data.shading.type", "MATERIAL"


def _light(context: bpy.types.Context, obj: bpy.types.Object | None) -> Prompt | None:
    result = result_of(context, obj, known_results(context.scene, context.view_layer))
    if result is None or result.reflection_mesh.role != "REFLECTION":
        return None
    if plays(result):
        return Prompt(pgettext_iface("Plays baked frames."), "FILE_CACHE")
    sentence = light_sentence(result, bool(why_light_differs(context, result)))
    return Prompt(pgettext_iface(sentence), "LIGHT") if sentence else Prompt(pgettext_iface("Up to date."), "CHECKMARK")


def _missing_mirror(context: bpy.types.Context, obj: bpy.types.Object | None) -> Prompt | None:
    """Return a prompt for a scene without a mirror, with the button that makes the active object one; else None."""
    if (obj is not None and obj.reflection_mesh.role in RESULTS) or not has_mirror(context):
        return None
    return missing_mirror_prompt(obj if obj is not None and can_take_part(obj) else None)


def missing_mirror_prompt(obj: bpy.types.Object | None) -> Prompt:
    """Return the prompt that says what makes a mirror; `obj` may become one."""
    text = pgettext_iface("The scene has no mirror. A mirror is metal with a Roughness up to 0.1, or has the role "
                          "Mirror.")
    return Prompt(text, "INFO", None if obj is None else partial(_draw_make_mirror, name=obj.name))


def _draw_make_mirror(layout: bpy.types.UILayout, name: str) -> None:
    layout.operator("reflection_mesh.make_mirror", icon="MOD_MIRROR", translate=False,
                    text=pgettext_iface("Make '{name}' a Mirror").format(name=name))


def _first_step(context: bpy.types.Context, _obj: bpy.types.Object | None) -> Prompt | None:
    if known_results(context.scene, context.view_layer):
        return Prompt(pgettext_iface("Up to date."), "CHECKMARK")
    return Prompt(pgettext_iface("Select a mirror, then click Generate Reflection."))


# the first that has something to say is shown
PROMPTS = (_live, _broken, _stale, _shading, _light, _missing_mirror, _first_step)
