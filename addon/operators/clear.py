"""Remove results and restore what they changed."""
from __future__ import annotations

import bpy

from ..faults import AllOrNothing, in_one_sentence, one_or_more, tell
from ..frames import plays, stop_playing
from ..illumination import bring_back_abandoned, bring_back_layers, forget_added_light
from ..lighting import forget_light, forget_previews, update_mattes
from ..reading import has_linked_results, is_result, named_by_selection, redraw_lines
from ..writing import close_abandoned_windows, disc_nodes, forget_collection, forget_nodes, set_free
from . import polls

IN_OBJECT_MODE = "Reflections are cleared in Object Mode: leave the present mode first."
NOTHING_TO_CLEAR = "The scene has no reflection to clear."
LINKED_TO_CLEAR = ("The reflections are linked from another file: clear them in that file, save it, and reload the "
                   "library here.")


def chosen_results(context: bpy.types.Context) -> list:
    """Return the selected results, or those of selected mirrors; all of the scene if the selection refers to none."""
    results = [obj for obj in context.scene.objects
               if is_result(obj) and obj.library is None]
    return named_by_selection(context, results) or results


def clear(context: bpy.types.Context, results: list) -> None:
    """Remove `results` with their meshes, unless something else uses those, and show mirrors without a result again."""
    layer = context.view_layer
    active = layer.objects.active
    mirror = active.reflection_mesh.mirror if active in results else None
    nodes = {disc_nodes(obj) for obj in results}
    lights = {obj.reflection_mesh.light_material for obj in results} - {None}
    _set_free(context, results)
    # from here on nothing can fail, so that results go all or none
    if mirror is not None and mirror.name in layer.objects:
        layer.objects.active = mirror
    _remove(results)
    redraw_lines(context.scene)
    for group in nodes:
        forget_nodes(group)
    for material in lights:
        forget_light(material)
    forget_previews()
    close_abandoned_windows()
    forget_collection(context.scene)
    update_mattes(context)


def chosen_caustics(context: bpy.types.Context) -> tuple[list, bool]:
    """Return the caustics that are selected or whose mirrors are, else all of the scene; and True if any are selected.
    """
    every = [obj for obj in context.scene.objects
             if obj.reflection_mesh.role == "CAUSTICS" and obj.library is None]
    named = named_by_selection(context, every)
    return named or every, bool(named)


def clear_caustics(caustics: list) -> None:
    """Remove `caustics` with their meshes and materials, and let Cycles show its own again where none are left."""
    remove_caustics(caustics)
    _bring_back()


def remove_caustics(caustics: list) -> None:
    """Remove `caustics` with their meshes and materials."""
    meshes = {obj.data for obj in caustics if isinstance(obj.data, bpy.types.Mesh)}
    materials = {material for mesh in meshes for material in mesh.materials} - {None}
    _remove(caustics)
    forget_added_light(list(materials))


def _bring_back() -> bool:
    """Bring back what was changed for light that no mesh shows any more; whether anything was."""
    return any([bring_back_abandoned(), bring_back_layers()])


def _remove(objects: list) -> None:
    """Remove objects, and their meshes where nothing else uses those."""
    meshes = {obj.data for obj in objects if isinstance(obj.data, bpy.types.Mesh)}
    for obj in objects:
        stop_playing(obj)
        bpy.data.objects.remove(obj)
    for mesh in meshes:
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def _set_free(context: bpy.types.Context, results: list) -> None:
    """Keep objects that the user has joined to results. Of results with a shared mesh, keep them once."""
    with AllOrNothing() as whole:
        for obj in {obj.data: obj for obj in results if not plays(obj)}.values():
            set_free(context, obj, whole)


class REFLECTION_MESH_OT_clear(bpy.types.Operator):
    """Remove the results of the selected mirrors, or all results in the scene, and restore what they changed"""

    bl_idname = "reflection_mesh.clear"
    bl_label = "Clear Reflections"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE),
                            polls.has_what_clears(NOTHING_TO_CLEAR, LINKED_TO_CLEAR))

    @in_one_sentence
    def execute(self, context: bpy.types.Context) -> set:
        if context.mode != "OBJECT":
            tell(self, {"ERROR"}, IN_OBJECT_MODE)
            return {"CANCELLED"}
        results, (caustics, named) = chosen_results(context), chosen_caustics(context)
        if named != bool(named_by_selection(context, results)):
            results, caustics = ([], caustics) if named else (results, [])
        if not results and not caustics and not _bring_back() and not any(
                obj.reflection_mesh.camera_hidden for obj in context.scene.objects):
            tell(self, {"WARNING"}, LINKED_TO_CLEAR if has_linked_results() else NOTHING_TO_CLEAR)
            return {"CANCELLED"}
        clear(context, results)
        _set_free(context, caustics)
        clear_caustics(caustics)
        told = one_or_more(len(results), "1 reflection", "{count} reflections")
        if caustics:
            words = ("{told} and 1 caustics object", "{told} and {count} caustics objects") if results else (
                "1 caustics object", "{count} caustics objects")
            told = one_or_more(len(caustics), *words, told=told)
        tell(self, {"INFO"}, f"{told} cleared.")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_clear)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_clear)
