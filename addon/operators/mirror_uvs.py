"""The operator that writes maps by which a picture looks right in a mirror: anamorphosis."""
from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ... import core
from ..anamorphosis import (
    SEEN,
    UV_MAP,
    Frame,
    cut_triangles,
    load_picture,
    own_map,
    paper_with,
    sheet,
    shown,
    source_of,
    write_copy,
    write_own_map,
)
from ..faults import AllOrNothing, SteppedOperator, Steps, one_or_more, part, tell_done
from ..reading import (
    Participants,
    choose,
    opacities_of,
    read_mirror,
    read_scene,
    read_view,
    with_square_pixels,
)
from ..settings import UsesSettings, Wanted, option
from . import polls
from .shortcomings import left_out

TARGETS = (
    ("COPY", "A Copy", "Write the map on a copy whose faces are cut where the map bends, and hide the object"),
    ("ORIGINAL", "The Object Itself", "Write the map on the object without cutting faces. Between vertices the map is"
                                      " less accurate"),
)
FRAMES = (
    ("CAMERA", "The Camera's View", "The image fills the camera's view"),
    ("WHOLE", "As Much As Is Shown Whole", "The image keeps its proportions and is as large as the mirror can show "
                                           "completely"),
    ("MIRROR", "What the Mirror Shows", "The image fills the bounding box of what the mirror shows of the objects"),
)
IN_OBJECT_MODE = "Mirror UVs are written in Object Mode: leave the present mode first."
# shares of the work
READING, REFLECTING, PIECES, CUTTING = 0.05, 0.45, 0.05, 0.4
TOLD = 1.0     # pixels


@dataclass(frozen=True)
class Choices:
    """The user's choices: entries of `TARGETS` and `FRAMES`, and the path of an image (or "")."""

    target: str = "COPY"
    frame: str = "CAMERA"
    picture: str = ""


@dataclass(frozen=True)
class Outcome:
    """The objects that carry a map now, and sentences on what was left out."""

    objects: list
    remarks: list

    def summary(self, seconds: float) -> str:
        """Return one line on what was written."""
        names = ", ".join(f"'{obj.name}'" for obj in self.objects)
        faces = one_or_more(sum(len(obj.data.polygons) for obj in self.objects), "1 face", "{count} faces")
        return f"{names}: UV map '{UV_MAP}', {faces}, those that are seen marked '{SEEN}', {seconds:.2f} s"


def map_settings(wanted: Wanted, chosen: Participants) -> core.Settings:
    """Return the settings of a reflection from which a map is made: one bounce, on the mirror itself.

    Raises
    ------
    core.ReflectionError
        If a setting is invalid.
    """
    own = wanted(chosen.mirrors[0])
    return core.Settings(tolerance=own.tolerance, maximum_memory=own.maximum_memory, placement="SURFACE")


def mapping(context: bpy.types.Context, chosen: Participants, settings: core.Settings,
            choices: Choices = Choices()) -> Steps[Outcome]:
    """Write for each of `chosen.diffuse` where the camera sees it in the mirror, yielding (fraction, stage).

    Nothing in the file changes before the last step; a generator that is closed before leaves no trace. `settings` are
    those of `map_settings`.

    Raises
    ------
    core.ReflectionError
        Where the mirror shows none of the objects, or the map cannot be written.
    """
    _check(context, chosen, choices)
    yield 0.0, "Reading the scene"
    with AllOrNothing() as whole:
        image = load_picture(choices.picture, whole) if choices.picture else None
        # pictures are of square pixels, whatever those of renders are
        view, mirror = with_square_pixels(read_view(context), context.scene.render), chosen.mirrors[0]
        # a copy that was made before is made anew from what it was copied from
        sources = list(dict.fromkeys(source_of(context, obj) for obj in chosen.diffuse))
        with shown(context, [obj for obj in sources if obj not in chosen.diffuse]):
            depsgraph = context.evaluated_depsgraph_get()
            surface = read_mirror(depsgraph, mirror)
            scene = read_scene(depsgraph, sources)
            opacity = opacities_of(depsgraph, scene)
        result = yield from part(core.reflection_steps(view, surface.mesh, scene.mesh, settings, opacity=opacity),
                                 READING, REFLECTING, mirror.name)
        pieces = yield from part(core.in_steps(lambda: core.picture_pieces(view, result)), READING + REFLECTING,
                                 PIECES, "Finding visible faces")
        indices = np.unique(scene.source_object[pieces.face]).tolist()
        if not indices:
            raise core.ReflectionError("The camera sees none of the objects in this mirror; move the camera, the "
                                       "mirror or the objects.")
        remarks = left_out(context, replace(chosen, hidden=[obj for obj in chosen.hidden if obj not in sources]))
        remarks += [f"Left out because the mirror does not show it: '{obj.name}'." for index, obj in enumerate(sources)
                    if index not in indices]
        yield READING + REFLECTING + PIECES, "Cutting faces"
        frame = Frame.of(choices.frame, view, pieces.pixels, image.size[0] / image.size[1] if image else 1.0)
        if choices.target == "ORIGINAL":
            maps = yield from part(core.in_steps(lambda: [own_map(index, scene, pieces) for index in indices]),
                                   1.0, 0.0, "Finding visible faces")
            remarks += [f"Between the corners of '{entry.source.name}' the picture is up to {entry.straying:.1f} px "
                        "off: subdivide it, or choose A Copy." for entry in maps if entry.straying > TOLD]
        else:
            parts = yield from part(cut_triangles(pieces, len(scene.mesh.triangles)),
                                    READING + REFLECTING + PIECES, CUTTING)
            sheets = yield from part(core.in_steps(lambda: [sheet(index, scene, parts, frame) for index in indices]),
                                     1.0, 0.0, "Cutting faces")
            remarks += [f"A mesh has eight UV maps at the most: '{name}' of '{entry.source.name}' is not on the copy."
                        for entry in sheets for name in entry.left_out]
        if choices.target == "ORIGINAL":
            objects = yield from _written(lambda entry: write_own_map(entry, frame, whole), maps)
        else:
            paper = paper_with(image, whole) if image else None
            objects = yield from _written(lambda entry: write_copy(context, entry, paper, whole), sheets)
        for obj in objects:
            whole.undo(setattr, obj.reflection_mesh, "mirror", obj.reflection_mesh.mirror)
            obj.reflection_mesh.mirror = mirror
    return Outcome(objects, remarks)


def _written(write: Callable[..., Steps[bpy.types.Object]], entries: list) -> Steps[list]:
    """Return the objects that the steps `write` make of entries."""
    objects = []
    for entry in entries:
        yield 1.0, "Writing"
        objects.append((yield from part(write(entry), 1.0, 0.0, "Writing")))
    return objects


def _check(context: bpy.types.Context, chosen: Participants, choices: Choices) -> None:
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    if len(chosen.mirrors) > 1:
        raise core.ReflectionError(f"Mirror UVs are those of one mirror, and here are {len(chosen.mirrors)}: select "
                                   "one of them with the objects that it shows.")
    if choices.picture and choices.target == "ORIGINAL":
        raise core.ReflectionError("A picture is put on copies alone: choose A Copy, or give the object a material "
                                   f"that shows the picture by the UV map '{UV_MAP}'.")


class REFLECTION_MESH_OT_mirror_uvs(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Add a UV map to the reflected objects with which an image looks right only in the mirror (anamorphosis)"""

    bl_idname = "reflection_mesh.mirror_uvs"
    bl_label = "Write Mirror UVs"
    bl_options = {"REGISTER", "UNDO"}

    uses = ("tolerance", "memory")

    tolerance: option("tolerance")
    memory: option("memory")
    target: bpy.props.EnumProperty(name="Write On", description="Object that gets the UV map", items=TARGETS,
                                   default="COPY", options={"SKIP_SAVE"})
    frame: bpy.props.EnumProperty(name="Picture Fills", description="Area that the image fills",
                                  items=FRAMES, default="CAMERA", options={"SKIP_SAVE"})
    picture: bpy.props.StringProperty(name="Picture", description="Image in this file or image file that the copies "
                                      "show. Empty writes only the map", subtype="FILE_PATH", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror,
                            polls.has_reflected, polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        # maps are written on what is chosen, and on nothing else
        chosen, wanted = choose(context, all_seen=False), self.wanted(context)
        outcome = yield from mapping(context, chosen, map_settings(wanted, chosen),
                                     Choices(self.target, self.frame, self.picture))
        self.show_used(wanted, chosen.mirrors)
        # the view layer knows new objects only from its next update on
        context.view_layer.update()
        for obj in outcome.objects:
            if obj.name in context.view_layer.objects:
                obj.select_set(True)
        tell_done(self, [outcome.summary(time.perf_counter() - started)], outcome.remarks)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_mirror_uvs)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_mirror_uvs)
