"""Sentences for the user on what a reflection lacks: limits that were reached, and objects that probes have missed."""
from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import ReflectionError, ReflectionMesh
from ...core.result import filled_share
from ..reading import (
    SHARP_ROUGHNESS,
    Assembly,
    MirrorSurface,
    Participants,
    camera_of,
    every_result_of,
    in_background_set,
    is_result,
    known_results,
    mirror_roughness,
    mirrors_of,
    rendered_alone,
    rendered_otherwise,
    why_caught,
    without_surface,
)
from ..reading.materials import transparency
from ..settings import SettingsOfMirrors, of_each
from ..writing import InTheWay

# shares of a virtual image behind other objects: from which on that is told, from which on its mirror is no window
PARTLY_HIDDEN, HIDDEN = 0.01, 0.5
MISSING = 3.0  # per cent of what the mirror shows
MANY = 200_000  # faces: of fewer nobody waits for long
WORTH_TELLING = 0.1  # per cent of a reflection
MISSED = 3  # probes: fewer may lie on an outline
DEPTH_OF_FIELD = ("Depth of field: the camera focuses on the mirror and not on what it shows; choose the placement "
                  "Virtual for flat mirrors, or blur after the render.")
MOTION_BLUR = ("Motion blur: the reflection is that of one moment, and is blurred as what lies on the mirror; blur it "
               "after the render, or switch motion blur off.")
STEREO = ("Stereoscopy: a reflection is right for one eye, and both show the same one; choose the placement Virtual "
          "for flat mirrors, or render each eye by a camera that has its own.")
NONE_SEEN = ("The camera sees none of the reflected objects in this mirror; move the camera, the mirror or the "
             "objects.")
TOO_CLOSE = ("A film or tinted pane is so close before this mirror that the reflection is left out behind it: move it "
             "away from the mirror by a thousandth of the camera's distance.")
CUTS = ("Markers change the camera: choose Render > Lock Interface, so that a render of the animation in this window "
        "shows each camera its own reflection.")


class Refused(ReflectionError):
    """Something stands against all that was asked for, as things are at the moment; its message is the first of the
    `sentences` that tell what."""

    def __init__(self, sentences: list[str]) -> None:
        super().__init__(sentences[0])
        self.sentences = sentences


# sentences by the name of a count; shown if the count is not zero. `share` is in per cent.
SENTENCES = {
    "crowded": "Dense areas were sampled at one ray per pixel ({share} % of this reflection). Raise Memory for exact "
               "outlines.",
    "overlaid": "The mirror overlaps itself too often to be cut exactly, so hidden objects may show. Simplify the "
                "mirror.",
    "pierced": "Too many faces pass through the mirror, so objects behind them may show. Simplify the objects that "
               "pass through it.",
    "many_outlines": "Too many outlines of mirrors cross, so some edges are rough. Simplify the mirrors.",
    "bounded": "Refinement stopped at the largest number of faces, so the error may exceed the tolerance. Raise "
               "Tolerance or Memory.",
    "coarse": "{share} % of the points are too far apart for discs without gaps. Subdivide the reflected objects, or "
              "set Made Of to Faces.",
}


def shortcomings(name: str, result: ReflectionMesh, materials: Sequence = ()) -> list[str]:
    """Return sentences on the reflection in the mirror `name` of objects with these materials."""
    counts, told = result.counts, []
    if counts.get("missed", 0) >= MISSED and result.missing_share > MISSING:
        told.append(f"About {result.missing_share:.0f} % of what the mirror shows is missing: give it a clean mesh, or "
                    "move the camera.")
    told += [TOO_CLOSE] * too_close(result, materials)
    return [f"{name}: {sentence}" for sentence in told + bounds_hit(counts, len(result.positions))]


def too_close(result: ReflectionMesh, materials: Sequence) -> bool:
    """Return True if a source with one of these materials, of which a part of light goes straight through, lies so
    close before the mirror that the reflection is left out behind it."""
    return bool(result.counts.get("too_close")) and any(map(transparency, materials))


def better_of_points(name: str, result: ReflectionMesh) -> list[str]:
    """Return a sentence if the reflection in the mirror `name` has more faces than the mirror has pixels, so that
    points would be better.
    """
    few = len(result.triangles) < max(MANY, result.counts.get("mirror_pixels", 0))
    if few or result.bounces.max() > 1:
        return []
    return [f"{name}: What it shows is finer than its pixels; with Made Of > Points it takes about half of the "
            "time."]


def bounds_hit(counts: dict, points: int = 0) -> list[str]:
    """Return sentences on limits that were reached, by `counts`, for a result of `points` points. Ignore areas that are
    too small to be visible.
    """
    shares = {"crowded": filled_share(counts), "coarse": 100.0 * counts.get("coarse", 0) / max(points, 1)}
    return [said.format(share=f"{shares.get(what, 0.0):.1f}") for what, said in SENTENCES.items()
            if counts.get(what) and shares.get(what, 100.0) >= WORTH_TELLING]


def left_out(context: bpy.types.Context, chosen: Participants) -> list[str]:
    """Return sentences on objects that would take part if they were visible, and on mirrors that are shadow catchers.
    """
    there = set(context.scene.objects)
    return [f"Left out because it is hidden: '{obj.name}'." if obj in there else
            f"Left out because it is not in this scene: '{obj.name}'." for obj in chosen.hidden
            ] + list(map(why_caught, chosen.caught))


def rough_shortcomings(mirrors: list, surfaces: list[MirrorSurface]) -> list[str]:
    """Return a sentence on mirrors that are rough, since their reflections are sharp."""
    found = []
    for mirror, surface in zip(mirrors, surfaces, strict=True):
        seen = [surface.materials[index] for index in np.unique(surface.material).tolist()]
        roughness = max((one for one in map(mirror_roughness, seen) if one is not None), default=0.0)
        if roughness > SHARP_ROUGHNESS:
            found.append((mirror.name, roughness))
    if not found:
        return []
    name, roughness = found[0]
    if len(found) > 1:
        return [f"{len(found)} mirrors are rough, '{name}' among them, and their reflections are sharp, where Cycles' "
                "are blurred."]
    if roughness == float("inf"):
        return [f"The roughness of '{name}' is not known, and its reflection is sharp, where Cycles' may be blurred."]
    return [f"'{name}' has a roughness of {roughness:.2f}, and its reflection is sharp, where Cycles' is blurred."]


def scene_shortcomings(context: bpy.types.Context, chosen: Participants, settings: SettingsOfMirrors) -> list[str]:
    """Return sentences on how renders differ from the reflections that were just generated. Call it before new objects
    are known.
    """
    placements = [own.placement for own in map(of_each(settings), chosen.mirrors)]
    return (render_shortcomings(context, chosen.mirrors, chosen.diffuse)
            + blur_shortcomings(context.scene, placements))


def blur_shortcomings(scene: bpy.types.Scene, placements: list[str]) -> list[str]:
    """Return sentences on blur and stereo of a render that results with these placements do not follow."""
    camera = scene.camera
    focused = camera is not None and camera.type == "CAMERA" and camera.data.dof.use_dof
    on_mirrors = any(placement != "VIRTUAL" for placement in placements)
    told = [DEPTH_OF_FIELD] * (focused and on_mirrors) + [STEREO] * (scene.render.use_multiview and on_mirrors)
    return told + [MOTION_BLUR] * scene.render.use_motion_blur


def render_shortcomings(context: bpy.types.Context, mirrors: list, diffuse: list) -> list[str]:
    """Return sentences on differences between renders and viewports, since a reflection shows the viewport: other
    meshes, objects hidden in the viewport only, and objects without a mesh.
    """
    told = other_meshes(context.scene, mirrors + diffuse) + _hidden(rendered_alone(context, mirrors, diffuse))
    told += [CUTS] * _cuts_unlocked(context, mirrors)
    told += [f"Renders show '{obj.name}' of the background set too, which no reflection shows: link it into this scene."
             for obj in in_background_set(context, mirrors, diffuse)[:1]]
    told += [f"'{mirror.name}' has a linked reflection too: hide one of the two." for mirror in mirrors
             if _has_linked_result(context, mirror)]
    return told + [f"No reflection has hair, point clouds or volumes, as '{obj.name}' has: make meshes of them, or "
                   "leave the mirror to Cycles." for obj in without_surface(context, mirrors, diffuse)[:1]]


def _has_linked_result(context: bpy.types.Context, mirror: bpy.types.Object) -> bool:
    """Return True if a visible reflection on the mirror is linked from another file."""
    return any(obj.library is not None and mirror in mirrors_of(obj) and obj.visible_get() and is_result(obj)
               for obj in known_results(context.scene, context.view_layer))


def _cuts_unlocked(context: bpy.types.Context, mirrors: list) -> bool:
    """Return True if markers switch between cameras with results of their own, but the interface is not locked during
    renders, so that results cannot be exchanged.
    """
    bound = {marker.camera for marker in context.scene.timeline_markers} - {None}
    return not context.scene.render.use_lock_interface and any(
        len(bound & {camera_of(result) for result in every_result_of(context, mirror)}) > 1 for mirror in mirrors)


def other_meshes(scene: bpy.types.Scene, objects: list) -> list[str]:
    """Return a sentence on objects whose mesh in renders differs from the viewport's."""
    found = [(obj.name, why) for obj in objects if (why := rendered_otherwise(scene, obj))]
    if not found:
        return []
    if len(found) == 1:
        return ["Renders show another mesh of '{}' than viewports do, by '{}', and what was generated has the "
                "viewport's: give both the same levels.".format(*found[0])]
    return ["Renders show other meshes of {} objects than viewports do, of '{}' by '{}', and what was generated has "
            "the viewport's: give both the same levels.".format(len(found), *found[0])]


def _hidden(found: list) -> list[str]:
    if not found:
        return []
    if len(found) == 1:
        return [f"Renders show '{found[0].name}', which is hidden in the viewport and so in no reflection: show it, or "
                "hide it in renders too."]
    return [f"Renders show {len(found)} objects, '{found[0].name}' among them, which are hidden in the viewport and so "
            "in no reflection: show them, or hide them in renders too."]


def window_shortcomings(joint: Assembly, found: InTheWay) -> list[str]:
    """Return sentences on the window that a mirror, or the parts of one, will be.

    Raises
    ------
    ReflectionError
        Where something hides most of what would be seen through it.
    """
    name = joint.mirror.name
    if any(part.library is not None and part.visible_camera for part in joint.parts):
        return [f"{name}: this mirror is linked and cannot be hidden, so that it stands before the virtual "
                "image; override it, or choose the placement Layered."]
    if found.hidden > HIDDEN:
        raise ReflectionError(f"'{found.name}' stands before the virtual image behind this mirror and would hide it; "
                              "choose the placement Layered, or hide that object from the camera.")
    if found.hidden > PARTLY_HIDDEN:
        return [f"{name}: '{found.name}' hides a part of the virtual image behind this mirror; the placement "
                "Layered shows all of it."]
    return []
