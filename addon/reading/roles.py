"""Who takes part in a reflection: the selected objects by role, or the objects with explicit roles."""
from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...core import ReflectionError
from .mirror_materials import is_mirror

RESULTS = {"REFLECTION", "CAUSTICS"}
NO_MIRROR = ("No mirror: select the objects to reflect and then, as the active object, the mirror, or set roles in the "
             "Reflection tab.")
GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class NothingSeen(ReflectionError):
    """There is a mirror, and something to reflect, and nothing of it is to be seen at the moment."""


@dataclass(frozen=True)
class Participants:
    """Mirrors and diffuse objects that take part, and those that would, were they not hidden."""

    mirrors: list
    diffuse: list
    hidden: list


def participants(context: bpy.types.Context) -> tuple[list, list]:
    """The mirrors and the diffuse objects that take part, as lists of objects in the order of the view layer.

    Raises
    ------
    ReflectionError
        Where there is no mirror or no diffuse object; the message says how to choose one.
    """
    chosen = choose(context)
    return chosen.mirrors, chosen.diffuse


def choose(context: bpy.types.Context) -> Participants:
    """As `participants`, with the objects that were left out because they are hidden.

    The selection decides by role. Where it gives no mirror or no diffuse object, an active result's own mirror and
    sources take part, else the objects of the view layer whose role is explicit.
    """
    return visible(context, *candidates(context))


def candidates(context: bpy.types.Context) -> tuple[list, list]:
    """The mirrors and the diffuse objects that `choose` chooses from, hidden ones among them."""
    active = context.view_layer.objects.active
    objects = [obj for obj in context.view_layer.objects if can_take_part(obj)]
    mirrors, diffuse = _by_role([obj for obj in objects if obj.select_get()], active)
    if not (mirrors and diffuse):
        if active is not None and active.reflection_mesh.role in RESULTS and active.reflection_mesh.mirror:
            mirrors, diffuse = _of_result(active)
        else:
            explicit = [obj for obj in objects if obj.reflection_mesh.role in {"MIRROR", "DIFFUSE"}]
            mirrors, diffuse = _by_role(explicit, None)
    return mirrors, diffuse


def can_take_part(obj: bpy.types.Object) -> bool:
    """Whether the object has faces to show, or instances of objects that may."""
    if obj.reflection_mesh.role in {"IGNORE", *RESULTS}:
        return False
    return obj.type in GEOMETRY or obj.is_instancer


def _by_role(objects: list, active: bpy.types.Object | None) -> tuple[list, list]:
    automatic = [obj for obj in objects if obj.reflection_mesh.role == "AUTO"]
    mirrors = [obj for obj in objects if obj.reflection_mesh.role == "MIRROR"]
    mirrors += [obj for obj in automatic if any(is_mirror(slot.material) for slot in obj.material_slots)]
    if not mirrors and active in automatic:
        mirrors = [active]
    return mirrors, [obj for obj in objects if obj not in mirrors]


def _of_result(result: bpy.types.Object) -> tuple[list, list]:
    mirror = result.reflection_mesh.mirror
    diffuse = [source.object for source in result.reflection_mesh.sources if source.object is not None]
    if mirror in diffuse:
        raise ReflectionError(f"'{mirror.name}' is both the mirror and a source of '{result.name}': choose another "
                              "mirror or remove it from the sources.")
    return [mirror], diffuse


def visible(context: bpy.types.Context, mirrors: list, diffuse: list) -> Participants:
    """Those of the candidates that are seen, in the viewport and in renders.

    Raises
    ------
    NothingSeen
        Where all mirrors or all diffuse objects are hidden.
    ReflectionError
        Where there are none.
    """
    shown = _rendered_collections(context.view_layer.layer_collection)
    in_layer = set(context.view_layer.objects)

    def is_seen(obj: bpy.types.Object) -> bool:
        return (obj in in_layer and obj.visible_get() and not obj.hide_render
                and any(collection in shown for collection in obj.users_collection))

    hidden = [obj for obj in mirrors + diffuse if not is_seen(obj)]
    seen = Participants([obj for obj in mirrors if obj not in hidden], [obj for obj in diffuse if obj not in hidden],
                        hidden)
    if not seen.mirrors:
        if mirrors:
            raise NothingSeen(f"The mirror '{mirrors[0].name}' is hidden: show it in the viewport and in renders.")
        raise ReflectionError(NO_MIRROR)
    if not seen.diffuse:
        if diffuse:
            raise NothingSeen(f"The diffuse object '{diffuse[0].name}' is hidden: show it in the viewport and in "
                              "renders.")
        raise ReflectionError("Nothing to reflect: select the objects to reflect together with the mirror, or set "
                              "their role to Reflected in the Reflection tab.")
    return seen


def _rendered_collections(layer_collection: bpy.types.LayerCollection) -> set:
    """The view layer's collections that are in renders: neither excluded nor hidden, themselves or through a parent."""
    found, waiting = set(), [layer_collection]
    while waiting:
        branch = waiting.pop()
        if not branch.collection.hide_render:
            waiting.extend(branch.children)
            if not branch.exclude:
                found.add(branch.collection)
    return found


def results_of(context: bpy.types.Context, mirror: bpy.types.Object) -> list:
    """Results in the scene that show the reflection in `mirror` and can be changed."""
    return [obj for obj in context.scene.objects if obj.reflection_mesh.role == "REFLECTION"
            and obj.reflection_mesh.mirror == mirror and obj.type == "MESH" and obj.library is None]
