"""Who takes part in a reflection: the selected objects by role, or the objects with explicit roles."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy

from ...core import ReflectionError
from .assemblies import Assembly
from .materials import all_fog, is_mirror, materials_on_faces, own_materials
from .moves import comes_and_goes
from .nothing_seen import NothingSeen
from .results import RESULTS, is_gone, lost_mirror, meant, of_results, with_joined

NO_MIRROR = ("No mirror: select the objects to reflect and then, as the active object, the mirror, or set roles in the "
             "Reflection tab.")
GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


@dataclass(frozen=True)
class Participants:
    """Mirrors and diffuse objects that take part, and those that would, were they not hidden; of these the diffuse ones
    of the scene, which take part again when they are shown. `assemblies` tell which mirrors are joined, if that does
    not follow from results and settings."""

    mirrors: list
    diffuse: list
    hidden: list
    waiting: list = field(default_factory=list)
    assemblies: tuple[Assembly, ...] = ()


def participants(context: bpy.types.Context) -> tuple[list, list]:
    """The mirrors and the diffuse objects that take part, as lists of objects in the order of the view layer.

    Raises
    ------
    ReflectionError
        Where there is no mirror or no diffuse object; the message says how to choose one.
    """
    chosen = choose(context)
    return chosen.mirrors, chosen.diffuse


def choose(context: bpy.types.Context, all_seen: bool = True, unmirrored: bool = False) -> Participants:
    """As `participants`, with the objects that were left out because they are hidden.

    The selection decides by role. Where it gives no mirror or no diffuse object, the mirrors and sources of the results
    in it, and of the mirrors in it that have results, take part; else the objects of the view layer whose role is
    explicit. Where nothing is selected and no object is said to be a mirror, those take part that their materials say
    are. Mirrors that are selected alone or found so, where no object is said to be reflected, show `all_seen`: whatever
    is there, as mirrors do; without that, nothing. What is hidden from glossy rays mirrors do not show, and throw light
    on: it takes part where `unmirrored` is said.
    """
    mirrors, diffuse = candidates(context, all_seen, unmirrored)
    active = context.view_layer.objects.active
    if not mirrors and active is not None and active.reflection_mesh.role in RESULTS and lost_mirror(active):
        raise ReflectionError(f"The mirror of '{active.name}' is gone: clear it, or select another mirror.")
    return visible(context, mirrors, diffuse, unmirrored)


def candidates(context: bpy.types.Context, all_seen: bool = True, unmirrored: bool = False) -> tuple[list, list]:
    """The mirrors and the diffuse objects that `choose` chooses from, hidden ones among them; with a mirror all parts
    that are joined with it."""
    mirrors, diffuse = _candidates(context, all_seen, unmirrored)
    mirrors = with_joined(context, mirrors)
    reflecting = set(mirrors)
    return mirrors, [obj for obj in diffuse if obj not in reflecting]


def _candidates(context: bpy.types.Context, all_seen: bool, unmirrored: bool) -> tuple[list, list]:
    # materials that Geometry Nodes give are known of what is evaluated
    context.evaluated_depsgraph_get()
    active = context.view_layer.objects.active
    objects = [obj for obj in context.view_layer.objects if can_take_part(obj)]
    chosen = [obj for obj in objects if obj.select_get()]
    mirrors, diffuse = _by_role(chosen, active)
    if mirrors and diffuse:
        return mirrors, diffuse
    results = meant(context, active)
    if results:
        return of_results(results)
    explicit = [obj for obj in objects if obj.reflection_mesh.role in {"MIRROR", "DIFFUSE"}]
    mirrors = [obj for obj in chosen if says_mirror(obj)]
    if not chosen and not any(obj.reflection_mesh.role == "MIRROR" for obj in explicit):
        is_seen = _seen_at_times(context)
        mirrors = [obj for obj in objects if says_mirror(obj) and is_seen(obj)]
    if mirrors:
        # what is a mirror without any doubt is meant, and the roles say what it shows
        return mirrors, shown_by(context, mirrors, all_seen, unmirrored)
    return _by_role(explicit, None)


def shown_by(context: bpy.types.Context, mirrors: list, all_seen: bool = True, unmirrored: bool = False) -> list:
    """What mirrors show that are chosen alone: what is said to be reflected, else, where that is `all_seen`, whatever
    is there now or at other frames; with what is hidden from glossy rays where `unmirrored` is said."""
    others = [obj for obj in context.view_layer.objects if can_take_part(obj) and obj not in mirrors]
    said = [obj for obj in others if obj.reflection_mesh.role == "DIFFUSE"]
    if said or not all_seen:
        return said
    is_seen = _seen_at_times(context)
    return [obj for obj in others if is_seen(obj) and (unmirrored or obj.visible_glossy or comes_and_goes(obj))]


def says_mirror(obj: bpy.types.Object, is_one: Callable[[bpy.types.Material | None], bool] = is_mirror) -> bool:
    """Whether an object is a mirror by its role or its material, as far as `is_one` tells of materials."""
    return obj.reflection_mesh.role == "MIRROR" or (obj.reflection_mesh.role == "AUTO" and _looks_it(obj, is_one))


def _looks_it(obj: bpy.types.Object, is_one: Callable[[bpy.types.Material | None], bool]) -> bool:
    """Whether an object has the material of a mirror, or is an instance of a collection in which all surfaces do."""
    # slots first: faces are many
    if any(map(is_one, own_materials(obj))) and any(map(is_one, materials_on_faces(obj))):
        return True
    if obj.instance_type != "COLLECTION" or obj.instance_collection is None:
        return False
    there = False
    for other in obj.instance_collection.all_objects:
        if can_take_part(other):
            if not _looks_it(other, is_one):
                return False
            there = True
    return there


def can_take_part(obj: bpy.types.Object) -> bool:
    """Whether the object may have faces to show, or instances of objects that may: fog has none."""
    return obj.reflection_mesh.role not in {"IGNORE", *RESULTS} and may_have_faces(obj) and not all_fog(obj)


def may_have_faces(obj: bpy.types.Object) -> bool:
    """Whether an object may be seen as faces: by itself, as instances, or as what Geometry Nodes make of it."""
    return obj.type in GEOMETRY or obj.is_instancer or any(modifier.type == "NODES" for modifier in obj.modifiers)


def _by_role(objects: list, active: bpy.types.Object | None) -> tuple[list, list]:
    automatic = [obj for obj in objects if obj.reflection_mesh.role == "AUTO"]
    mirrors = [obj for obj in objects if obj.reflection_mesh.role == "MIRROR"]
    mirrors += [obj for obj in automatic if says_mirror(obj)]
    if not mirrors and active in automatic:
        mirrors = [active]
    reflecting = set(mirrors)
    return mirrors, [obj for obj in objects if obj not in reflecting]


def visible(context: bpy.types.Context, mirrors: list, diffuse: list, unmirrored: bool = False) -> Participants:
    """Those of the candidates that are seen, in the viewport and in renders; and in mirrors, but where `unmirrored` is
    said.

    Raises
    ------
    NothingSeen
        Where all mirrors or all diffuse objects are hidden.
    ReflectionError
        Where there are none.
    """
    is_seen = seen_in(context)
    # mirrors show what glossy rays meet, as in Cycles
    hidden = [obj for obj in mirrors if not is_seen(obj)]
    there = set(context.scene.objects)
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
    """What is said where a mirror is chosen and nothing that it is to show."""
    return (f"Nothing to reflect in '{mirror.name}': select the objects to reflect together with it, or set their role "
            "to Reflected in the Reflection tab.")


def _why_unseen(obj: bpy.types.Object, there: set, hidden: str) -> str:
    """The sentence `hidden`, but of what is not `there` in the scene, as where a result was appended alone."""
    if obj in there:
        return hidden
    if is_gone(obj):
        return (f"'{obj.name}' is not in this scene, as after it was deleted or joined to another object: clear the "
                "result, or add it to one of the scene's collections.")
    return f"'{obj.name}' is not in this scene: add it to one of the scene's collections."


def seen_in(context: bpy.types.Context) -> Callable[[bpy.types.Object], bool]:
    """Tells of an object whether it is seen, in the viewport and in renders."""
    in_layer, rendered = set(context.view_layer.objects), rendered_in(context.view_layer)
    return lambda obj: obj in in_layer and obj.visible_get() and rendered(obj)


def _seen_at_times(context: bpy.types.Context) -> Callable[[bpy.types.Object], bool]:
    """As `seen_in`, but of what comes and goes too: frames show it, and results know it from then on."""
    in_layer, is_seen = set(context.view_layer.objects), seen_in(context)
    return lambda obj: is_seen(obj) or (obj in in_layer and comes_and_goes(obj))


def rendered_in(layer: bpy.types.ViewLayer) -> Callable[[bpy.types.Object], bool]:
    """Tells of an object of a view layer whether it is in renders."""
    # what each object's own list of collections says, which is worked out anew whenever it is asked
    rendered = {obj for collection in rendered_collections(layer.layer_collection) for obj in collection.objects}
    return lambda obj: not obj.hide_render and obj in rendered


def in_viewports(context: bpy.types.Context) -> set:
    """The objects of the view layer that are in viewports, were it not for the eyes of collections in the outliner."""
    shown = rendered_collections(context.view_layer.layer_collection, "hide_viewport")
    return {obj for collection in shown for obj in collection.objects
            if not (obj.hide_viewport or obj.hide_get(view_layer=context.view_layer))}


def rendered_collections(layer_collection: bpy.types.LayerCollection, hidden_by: str = "hide_render") -> set:
    """The view layer's collections that are in renders, or in what else `hidden_by` says: neither excluded nor hidden,
    themselves or through a parent."""
    found, waiting = set(), [layer_collection]
    while waiting:
        branch = waiting.pop()
        if not getattr(branch.collection, hidden_by):
            waiting.extend(branch.children)
            if not branch.exclude:
                found.add(branch.collection)
    return found
