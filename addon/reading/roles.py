"""Choose the mirrors and the reflected objects, from the selection, the roles and the scene."""
from __future__ import annotations

from dataclasses import replace

import bpy

from ...core import ReflectionError
from .hidden_objects import Participants, catches_shadows, seen_at_times, visible, why_caught
from .materials import look_again
from .mirror_objects import can_take_part, mirrors_among, of_selection, rough_among
from .moves import comes_and_goes
from .results import RESULTS, lost_mirror, meant, of_results, showing, with_joined


def participants(context: bpy.types.Context) -> tuple[list, list]:
    """Return the mirrors and the diffuse objects that take part, two lists in the order of the view layer.

    Raises
    ------
    ReflectionError
        If there is no mirror or no diffuse object. The message says how to choose one.
    """
    chosen = choose(context)
    return chosen.mirrors, chosen.diffuse


def choose(context: bpy.types.Context, all_seen: bool = True, unmirrored: bool = False) -> Participants:
    """Choose the mirrors and the diffuse objects, and list those that are left out as hidden or as shadow catchers.

    The mirrors are the first of these that exist:

    1. selected mirrors, if other objects are selected too: they show these;
    2. mirrors of results that are selected, or whose mirror is: they show the objects of these results;
    3. mirrors that are selected alone;
    4. mirrors of results that show a selected object: they show the objects of these results;
    5. mirrors of the scene, by role, or by material if none has the role.

    Mirrors of kinds 3 and 5 show the objects with the role Reflected. If there are none, they show every visible
    object (`all_seen`), or else the other selected ones.

    Parameters
    ----------
    unmirrored : bool
        Keep objects that are hidden from glossy rays, and mirrors that are shadow catchers. Caustics need both.

    Raises
    ------
    ReflectionError
        If there is no mirror or no diffuse object. The message says how to choose one.
    """
    mirrors, diffuse = _with_parts(context, all_seen, unmirrored)
    active = context.view_layer.objects.active
    if not mirrors and active is not None and active.reflection_mesh.role in RESULTS and lost_mirror(active):
        raise ReflectionError(f"The mirror of '{active.name}' is gone: clear it, or select another mirror.")
    return seen_by_camera(context, mirrors, diffuse, unmirrored)


def seen_by_camera(context: bpy.types.Context, mirrors: list, diffuse: list, unmirrored: bool = False) -> Participants:
    """Leave out hidden objects, see `visible`, and mirrors that are shadow catchers unless `unmirrored` is set.

    Raises
    ------
    ReflectionError
        As `visible`, and where all mirrors are shadow catchers.
    """
    kept, caught = (mirrors, []) if unmirrored else without_shadow_catchers(mirrors)
    return replace(visible(context, kept, diffuse, unmirrored), caught=caught)


def without_shadow_catchers(mirrors: list) -> tuple[list, list]:
    """Return the mirrors in which Cycles shows a reflection, and those that are shadow catchers.

    Raises
    ------
    ReflectionError
        If all of them are shadow catchers.
    """
    caught = list(filter(catches_shadows, mirrors))
    if caught and len(caught) == len(mirrors):
        raise ReflectionError(why_caught(caught[0]))
    return [obj for obj in mirrors if obj not in caught], caught


def candidates(context: bpy.types.Context, all_seen: bool = True, unmirrored: bool = False) -> tuple[list, list]:
    """Return the mirrors and the diffuse objects that `choose` chooses from, hidden ones among them; with a mirror all
    parts that are joined with it."""
    mirrors, diffuse = _with_parts(context, all_seen, unmirrored)
    return [obj for obj in mirrors if unmirrored or not catches_shadows(obj)], diffuse


def shadow_catchers(context: bpy.types.Context) -> list:
    """Return the mirrors that `candidates` leaves out because they are shadow catchers, joined parts included."""
    return list(filter(catches_shadows, _with_parts(context, True, False)[0]))


def _with_parts(context: bpy.types.Context, all_seen: bool, unmirrored: bool) -> tuple[list, list]:
    """Return mirrors with all parts that are joined with them, and the diffuse objects that are none of these."""
    mirrors, diffuse = _named_or_found(context, all_seen, unmirrored)
    mirrors = with_joined(context, mirrors)
    reflecting = set(mirrors)
    return mirrors, [obj for obj in diffuse if obj not in reflecting]


def _named_or_found(context: bpy.types.Context, all_seen: bool, unmirrored: bool) -> tuple[list, list]:
    """Return the mirrors and diffuse objects of `choose`, hidden objects and shadow catchers included."""
    # materials that Geometry Nodes set are known only after evaluation
    context.evaluated_depsgraph_get()
    look_again()
    active = context.view_layer.objects.active
    objects = [obj for obj in context.view_layer.objects if can_take_part(obj)]
    chosen = [obj for obj in objects if obj.select_get()]
    mirrors = of_selection(chosen, active)
    diffuse = [obj for obj in chosen if obj not in mirrors]
    if mirrors and diffuse:
        return mirrors, diffuse
    results, mirrors = meant(context, active), mirrors_among(chosen)
    if not (results or mirrors):
        # rough metal that is selected alone is asked for; what is shown already is shown again
        mirrors = rough_among(chosen)
        results = [] if mirrors else showing(context, chosen)
    if results:
        return of_results(results)
    mirrors = mirrors or _of_the_scene(context, objects)
    if not mirrors:
        return [], []
    # a click may have selected the active object by chance, so the mirrors show the others too
    shown = shown_by(context, mirrors, all_seen, unmirrored)
    return mirrors, shown or [obj for obj in chosen if obj not in mirrors]


def _of_the_scene(context: bpy.types.Context, objects: list) -> list:
    """Return the mirrors of a scene: objects with that role, or, if there are none, visible objects with a mirror
    material.
    """
    said = [obj for obj in objects if obj.reflection_mesh.role == "MIRROR"]
    is_seen = seen_at_times(context)
    return said or mirrors_among([obj for obj in objects if obj.reflection_mesh.role == "AUTO" and is_seen(obj)])


def shown_by(context: bpy.types.Context, mirrors: list, all_seen: bool = True, unmirrored: bool = False) -> list:
    """Return the objects that `mirrors` show if they are chosen without others. These are the objects with the role
    Reflected. If there are none and `all_seen` is set, these are all objects visible now or at other frames. Include
    objects that are hidden from glossy rays only if `unmirrored` is set.
    """
    others = [obj for obj in context.view_layer.objects if can_take_part(obj) and obj not in mirrors]
    said = [obj for obj in others if obj.reflection_mesh.role == "DIFFUSE"]
    if said or not all_seen:
        return said
    is_seen = seen_at_times(context)
    return [obj for obj in others if is_seen(obj) and (unmirrored or obj.visible_glossy or comes_and_goes(obj))]
