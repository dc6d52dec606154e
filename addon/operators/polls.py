"""Why an operator cannot run now, in a sentence: what is cheap to tell and certain, since every redraw asks.

What an operator finds out only as it works, it says then, in its report.
"""
from __future__ import annotations

from collections.abc import Callable
from itertools import islice

import bpy

from ..anamorphosis import why_no_sheet
from ..faults import translated
from ..illumination import NO_LAMP, is_glint, is_mesh_lamp, leaves_out_any, raises_layers
from ..reading import (
    NO_CAMERA,
    NO_MIRROR,
    RESULTS,
    SHARP_ROUGHNESS,
    can_take_part,
    has_linked_results,
    instances_otherwise,
    is_result,
    least_roughness,
    may_say_mirror,
    nothing_to_reflect,
    says_mirror,
)

NO_SHEET = "No sheet: make the object that carries the mirror UVs the active one."
LINKED_SCENE = "The scene is linked from another file: open that file, or choose a scene of this one."
LOOKED_AT = 8           # selected objects
LOOKED_THROUGH = 500    # objects: to look for roles in more takes longer than a redraw may
Obstacle = Callable[[bpy.types.Context], str]


def passes(cls, context: bpy.types.Context, *obstacles: Obstacle) -> bool:
    """Return True if no obstacle prevents an operator. Otherwise Blender shows the first obstacle's sentence on the
    greyed-out button.
    """
    if getattr(context, "scene", None) is None or getattr(context, "view_layer", None) is None:
        return False
    sentence = next(filter(None, (obstacle(context) for obstacle in obstacles)), "")
    if sentence:
        cls.poll_message_set(translated(sentence))
    return not sentence


def in_object_mode(sentence: str) -> Obstacle:
    """Return an obstacle that says `sentence` in every mode but Object Mode, and says that the scene is linked if it
    is.
    """
    def obstacle(context: bpy.types.Context) -> str:
        if context.scene.library is not None:
            return LINKED_SCENE
        return "" if getattr(context, "mode", "OBJECT") == "OBJECT" else sentence
    return obstacle


def has_camera(context: bpy.types.Context) -> str:
    """Return a sentence if the scene has no camera, else ""."""
    return "" if context.scene.camera is not None else NO_CAMERA


def has_mirror(context: bpy.types.Context) -> str:
    """Return a sentence if the scene has no mirror by role or material, and no selected or active object may be a
    mirror or is shown by one; else "".
    """
    objects = context.view_layer.objects
    active = objects.active
    if active is not None and active.reflection_mesh.role in {"REFLECTION", "CAUSTICS", "MIRROR"}:
        return ""
    selected = list(islice(objects.selected, LOOKED_AT + 1))
    chosen = [obj for obj in selected if can_take_part(obj)]
    if (len(selected) > LOOKED_AT or len(chosen) > 1 or len(bpy.data.materials) > LOOKED_THROUGH
            or any(obj.reflection_mesh.role in RESULTS for obj in selected)):
        return ""
    # a selected object may have been a mirror, or be shown by one that has no mirror material any more
    rough = {one: roughness for one in bpy.data.materials if (roughness := least_roughness(one)) is not None}
    sharp = {one for one, roughness in rough.items() if roughness <= SHARP_ROUGHNESS}
    found = any(may_say_mirror(obj, set(rough)) for obj in chosen) or _any(
        objects, lambda obj: may_say_mirror(obj, sharp) and can_take_part(obj)) or (
        selected and _any(context.scene.objects, lambda obj: _knows_any(obj.reflection_mesh, selected)))
    return "" if found else NO_MIRROR


def has_reflected(context: bpy.types.Context) -> str:
    """Not a mirror alone is selected where no role or result says what it shows."""
    objects = context.view_layer.objects
    selected = list(islice(objects.selected, 2))
    # a run looks through instances, which may be many
    if len(selected) != 1 or instances_otherwise(selected[0]) or not (
            can_take_part(selected[0]) and says_mirror(selected[0])) or _any(
            objects, lambda obj: obj.reflection_mesh.role in {"DIFFUSE", *RESULTS}):
        return ""
    return nothing_to_reflect(selected[0])


def has_mirror_or_caustics(context: bpy.types.Context) -> str:
    """Check like `has_mirror`, but accept caustics in the scene as well."""
    return has_mirror(context) and ("" if _any(context.view_layer.objects, lambda obj: (
        obj.reflection_mesh.role == "CAUSTICS")) else NO_MIRROR)


def has_result(sentence: str, linked: str) -> Obstacle:
    """Return an obstacle that says `sentence` if the scene has no reflection, or `linked` if the file has only linked
    ones.
    """
    def obstacle(context: bpy.types.Context) -> str:
        active = context.view_layer.objects.active
        if (active is not None and _is_result(active)) or _any(context.scene.objects, _is_result):
            return ""
        return _missing(context, sentence, linked)
    return obstacle


def _missing(context: bpy.types.Context, sentence: str, linked: str) -> str:
    few = len(context.blend_data.objects) <= LOOKED_THROUGH
    return linked if few and has_linked_results() else sentence


def has_what_clears(sentence: str, linked: str) -> Obstacle:
    """Tells `sentence` in a window where the scene has no result, and nothing has been changed for one that is gone, or
    `linked` where the file has linked ones; scripts in the background may clear to be sure."""
    def obstacle(context: bpy.types.Context) -> str:
        if bpy.app.background:
            return ""
        if _any(context.scene.objects, _is_made_or_window) or leaves_out_any() or raises_layers():
            return ""
        return _missing(context, sentence, linked)
    return obstacle


def has_lamp(context: bpy.types.Context) -> str:
    """Return a sentence if the view layer has no lamp, and no selected object or result may provide one; else ""."""
    objects = context.view_layer.objects
    active, selected = objects.active, list(islice(objects.selected, LOOKED_AT + 1))
    if len(selected) > LOOKED_AT or any(map(is_mesh_lamp, selected)) or (
            active is not None and active.reflection_mesh.role == "CAUSTICS"):
        return ""
    return "" if _any(objects, lambda obj: obj.type == "LIGHT") else NO_LAMP


def has_sheet(context: bpy.types.Context) -> str:
    """Return a sentence if the active object has no map of a mirror, else ""."""
    active = context.view_layer.objects.active
    return NO_SHEET if active is None else why_no_sheet(active)


def has_what_is_kept_right(sentence: str) -> Obstacle:
    """Tells `sentence` in a window where the scene has neither reflections nor light of mirrors; scripts in the
    background may update to be sure."""
    def obstacle(context: bpy.types.Context) -> str:
        return "" if bpy.app.background or _any(context.scene.objects, lambda obj: (
            obj.reflection_mesh.role in RESULTS)) else sentence
    return obstacle


def _any(objects, asked: Callable) -> bool:
    """Return True if one of the objects passes the test `asked`. Assume it if there are too many to test."""
    return len(objects) > LOOKED_THROUGH or any(map(asked, objects))


def _knows_any(record: bpy.types.PropertyGroup, selected: list) -> bool:
    known = {record.mirror, *(part.object for part in record.parts)}
    if record.role == "REFLECTION":
        known.update(source.object for source in record.sources)
    return not known.isdisjoint(selected)


def _is_result(obj: bpy.types.Object) -> bool:
    return is_result(obj) and obj.library is None


def _is_made_or_window(obj: bpy.types.Object) -> bool:
    record = obj.reflection_mesh
    return (record.role in RESULTS and obj.library is None) or record.camera_hidden or is_glint(obj)
