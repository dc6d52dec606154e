"""Visibility of objects in the viewport, in renders, to glossy rays and to the camera."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy

from ...core import ReflectionError
from .assemblies import Assembly
from .moves import comes_and_goes
from .nothing_seen import NothingSeen
from .results import is_gone

NO_MIRROR = ("No mirror: select the objects to reflect and then, as the active object, the mirror, or set roles in the "
             "Reflection tab.")


@dataclass(frozen=True)
class Participants:
    """Mirrors and diffuse objects that take part in a reflection, and the objects that are left out.

    Attributes
    ----------
    mirrors, diffuse : list of bpy.types.Object
    hidden : list of bpy.types.Object
        Objects that would take part if they were not hidden.
    waiting : list of bpy.types.Object
        Diffuse objects of the scene that are hidden in the viewport or in renders, not from glossy rays alone. They
        take part again as soon as they are shown.
    caught : list of bpy.types.Object
        Mirrors that are left out because they are shadow catchers.
    assemblies : tuple of Assembly
        Which mirrors are joined, if that does not follow from results and settings.
    """

    mirrors: list
    diffuse: list
    hidden: list
    waiting: list = field(default_factory=list)
    caught: list = field(default_factory=list)
    assemblies: tuple[Assembly, ...] = ()


def catches_shadows(obj: bpy.types.Object) -> bool:
    """Return True for a shadow catcher, and for an instance of a collection of nothing but these: Cycles shows no
    reflection in them, be the film transparent or not."""
    if obj.is_shadow_catcher or obj.instance_type != "COLLECTION" or obj.instance_collection is None:
        return obj.is_shadow_catcher
    surfaces = [other for other in obj.instance_collection.all_objects if other.type == "MESH"]
    return bool(surfaces) and all(other.is_shadow_catcher for other in surfaces)


def why_caught(mirror: bpy.types.Object) -> str:
    """Return the sentence on a mirror that is left out because it is a shadow catcher."""
    return (f"'{mirror.name}' is a shadow catcher, in which Cycles shows no reflection: switch off Shadow Catcher in "
            "Object Properties > Visibility.")


def visible(context: bpy.types.Context, mirrors: list, diffuse: list, unmirrored: bool = False) -> Participants:
    """Leave out the candidates that are hidden in the viewport or in renders.

    Diffuse objects that are hidden from glossy rays are left out too, unless `unmirrored` is set.

    Raises
    ------
    NothingSeen
        If all mirrors or all diffuse objects are hidden.
    ReflectionError
        If there is no mirror or no diffuse object.
    """
    is_seen = seen_in(context)
    hidden = [obj for obj in mirrors if not is_seen(obj)]
    there = set(context.scene.objects)
    # mirrors in Cycles show only objects that are visible to glossy rays
    unseen = [obj for obj in diffuse if not (is_seen(obj) and (unmirrored or obj.visible_glossy))]
    out = {*hidden, *unseen}
    seen = Participants([obj for obj in mirrors if obj not in out], [obj for obj in diffuse if obj not in out],
                        hidden + unseen, [obj for obj in unseen if obj in there and not is_seen(obj)])
    if not seen.mirrors:
        if mirrors:
            raise NothingSeen(_why_unseen(mirrors[0], there, (
                f"The mirror '{mirrors[0].name}' is hidden: show it in the viewport and in renders.")))
        raise ReflectionError(NO_MIRROR)
    if not seen.diffuse:
        if diffuse:
            raise NothingSeen(_why_unseen(diffuse[0], there, (
                f"The reflected object '{diffuse[0].name}' is hidden: show it in the viewport, in renders and to "
                "glossy rays.")))
        raise ReflectionError(nothing_to_reflect(seen.mirrors[0]))
    return seen


def nothing_to_reflect(mirror: bpy.types.Object) -> str:
    """Return the message for a mirror without an object to reflect."""
    return (f"Nothing to reflect in '{mirror.name}': select the objects to reflect together with it, or set their role "
            "to Reflected in the Reflection tab.")


def _why_unseen(obj: bpy.types.Object, there: set, hidden: str) -> str:
    """Return the message `hidden`, or another one if the object is not among the scene's objects, `there`."""
    if obj in there:
        return hidden
    if is_gone(obj):
        return (f"'{obj.name}' is not in this scene, as after it was deleted or joined to another object: clear the "
                "result, or add it to one of the scene's collections.")
    return f"'{obj.name}' is not in this scene: add it to one of the scene's collections."


def seen_in(context: bpy.types.Context) -> Callable[[bpy.types.Object], bool]:
    """Return a function that is True for objects that the viewport and renders show."""
    in_layer, rendered = set(context.view_layer.objects), rendered_in(context.view_layer)
    return lambda obj: obj in in_layer and obj.visible_get() and rendered(obj)


def seen_at_times(context: bpy.types.Context) -> Callable[[bpy.types.Object], bool]:
    """Return a function that is True for objects that are visible now, or whose visibility is animated."""
    in_layer, is_seen = set(context.view_layer.objects), seen_in(context)
    return lambda obj: is_seen(obj) or (obj in in_layer and comes_and_goes(obj))


def rendered_in(layer: bpy.types.ViewLayer) -> Callable[[bpy.types.Object], bool]:
    """Return a function that is True for objects of a view layer that renders show."""
    # the same as `obj.users_collection`, which Blender computes anew on every access
    rendered = {obj for collection in rendered_collections(layer.layer_collection) for obj in collection.objects}
    return lambda obj: not obj.hide_render and obj in rendered


def in_viewports(context: bpy.types.Context) -> set:
    """Return the view layer's objects that are enabled in viewports.

    An object must not be hidden by its own eye icon or its own monitor icon (Disable in Viewports). It must also be in
    a collection that is not excluded, and not disabled in viewports itself or through a parent. The eye icons of
    collections and the camera icons (Disable in Renders) do not count.
    """
    shown = rendered_collections(context.view_layer.layer_collection, "hide_viewport")
    return {obj for collection in shown for obj in collection.objects
            if not (obj.hide_viewport or obj.hide_get(view_layer=context.view_layer))}


def rendered_collections(layer_collection: bpy.types.LayerCollection, hidden_by: str = "hide_render") -> set:
    """Return the view layer's collections that are not excluded, and not hidden themselves or through a parent.

    The property `hidden_by` says what hides a collection: "hide_render" or "hide_viewport".
    """
    found, waiting = set(), [layer_collection]
    while waiting:
        branch = waiting.pop()
        if not getattr(branch.collection, hidden_by):
            waiting.extend(branch.children)
            if not branch.exclude:
                found.add(branch.collection)
    return found
