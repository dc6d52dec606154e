"""The main job: read the scene, reflect it in each mirror, write one object per mirror."""
from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

import bpy

from ... import core
from ..faults import SteppedOperator, Steps, part, tell_done
from ..freshness import origin_of, record_of, settings_of
from ..reading import (
    DiffuseScene,
    MirrorSurface,
    NothingSeen,
    Participants,
    choose,
    is_opaque,
    is_part,
    lines_drawn,
    looked_through,
    read_view,
)
from ..settings import (
    SETTINGS,
    WRITTEN_SETTINGS,
    SettingsOfMirrors,
    SettingsOptions,
    UsesSettings,
    attributes_of,
    of_each,
    option,
)
from ..standing import Kept, Stage
from ..writing import MeshArrays, Reflection, mesh_arrays, point_arrays
from . import polls
from .shortcomings import (
    Refused,
    left_out,
    rough_shortcomings,
    scene_shortcomings,
    shortcomings,
    window_shortcomings,
)
from .write_results import Manners, Outcome, write_results

# share of the work that reading takes, before the mirrors are reflected one by one
READING = 0.1
IN_OBJECT_MODE = "Reflections are generated in Object Mode: leave the present mode first."
# what whoever presses a button gets unless it is set otherwise
FOR_THE_EYE = ("preview", "collect", "select_alone")


def generation(context: bpy.types.Context, chosen: Participants, settings: core.Settings | SettingsOfMirrors,
               preview: bool = False, manners: Manners = Manners(), view: core.View | None = None) -> Steps[Outcome]:
    """Generate the reflections of `chosen.diffuse` in `chosen.mirrors`, yielding (fraction 0..1, stage).

    Nothing in the file changes before the last step, which writes all results, or none where one of them fails; a
    generator that is closed before leaves no trace. Of several mirrors, those that cannot show anything are left out
    with a remark. The eye is the `view` that is given, else the scene's camera.

    Parameters
    ----------
    settings : core.Settings, or a function that gives those of a mirror

    Raises
    ------
    core.ReflectionError
        Where the input cannot be reflected; its message is one sentence for the user.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    started = time.perf_counter()
    yield 0.0, "Reading the scene"
    told, view = left_out(context, chosen), view or read_view(context)
    depsgraph = context.evaluated_depsgraph_get()
    kept = Kept.of(depsgraph)
    chosen, meshes, faceless = _with_faces(chosen, *kept.looked_at(depsgraph, chosen.mirrors, chosen.diffuse))
    own, sources = list(map(of_each(settings), chosen.mirrors)), chosen.diffuse + chosen.waiting
    origins = {mirror: record_of(origin_of(depsgraph, view, mirror, sources), settings_of(context.scene, mirror))
               for mirror in chosen.mirrors}
    joined = partial(kept.joined, chosen.mirrors, chosen.diffuse, *meshes)
    stage = yield from part(core.in_steps(joined), 0.0, 0.5 * READING, "Reading the scene")
    scene, surfaces = stage.scene, stage.surfaces
    told += faceless + rough_shortcomings(chosen.mirrors, surfaces)
    if not all(map(is_opaque, scene.materials)) or looked_through(depsgraph, chosen.mirrors, chosen.diffuse):
        own = [replace(one, hidden_faces=True) for one in own]
    kinds = [core.PointTree if one.method == "POINTS" else core.SceneTree for one in own]
    yield from _trees(stage, kinds)
    prepared, refused, unseen, lacks, share = [], [], [], [], (1.0 - READING) / len(surfaces)
    for index, (mirror, surface) in enumerate(zip(chosen.mirrors, surfaces)):
        steps = core.reflection_steps(view, surface.mesh, stage.built(kinds[index]), own[index])
        try:
            result = yield from part(steps, READING + index * share, share, mirror.name)
            if own[index].placement == "VIRTUAL":
                lacks += window_shortcomings(context, mirror, view, result, chosen.mirrors)
        except core.ReflectionError as error:
            refused.append(f"{mirror.name}: {error}")
            unseen += refused[-1:] * isinstance(error, core.NothingInView)
            continue
        if not len(result.positions):
            refused.append(f"{mirror.name}: The camera sees none of the reflected objects in this mirror; move the "
                           "camera, the mirror or the objects.")
            unseen += refused[-1:]
            continue
        lacks += shortcomings(mirror.name, result)
        written = partial(_written, result, scene, (surface, surfaces), view, lines_drawn(context.scene))
        result, arrays = yield from part(core.in_steps(written), READING + (index + 1) * share, 0.0,
                                         f"{mirror.name}: Writing")
        prepared.append(Reflection(mirror, context.scene.camera, sources, result, arrays, view.resolution,
                                   own[index].placement, attributes_of(settings, mirror, context.scene)))
    if not prepared:
        raise NothingSeen(refused[0]) if unseen == refused else Refused(refused)
    kept.within(max(one.maximum_memory for one in own))
    yield 1.0, "Writing"
    outcome = write_results(context, prepared, view, scene, preview, manners)
    _record(outcome, origins, time.perf_counter() - started)
    return replace(outcome, remarks=told + lacks + outcome.remarks + refused,
                   lacks=lacks + [sentence for sentence in refused if sentence not in unseen],
                   read=(view, dict(zip(chosen.mirrors, surfaces)), scene))


def _written(result: core.ReflectionMesh, scene: DiffuseScene, mirrors: tuple[MirrorSurface, list[MirrorSurface]],
             view: core.View, lines: bool) -> tuple[core.ReflectionMesh, MeshArrays]:
    """A result as it is to be written, and its arrays: where lines are drawn, its faces share vertices. It was made of
    one of the mirrors, and then of them all."""
    surface, every = mirrors
    if result.discs is not None:
        return result, point_arrays(result, scene, surface, view)
    if lines:
        result = core.with_borders_closed(result, view, scene.mesh, scene.source_object)
    return result, mesh_arrays(result, scene, surface, view, every)


def _with_faces(chosen: Participants, of_mirrors: list, placed: list) -> tuple[Participants, tuple, list[str]]:
    """Without the mirrors that have no faces, as curves that others follow, where some have, and sentences on these."""
    faceless = [mirror for mirror, own in zip(chosen.mirrors, of_mirrors) if not own]
    if not 0 < len(faceless) < len(chosen.mirrors):
        return chosen, (of_mirrors, placed), []
    return (replace(chosen, mirrors=[mirror for mirror in chosen.mirrors if mirror not in faceless]),
            ([own for own in of_mirrors if own], placed),
            [f"Left out because it has no faces: '{obj.name}'." for obj in faceless if not is_part(obj)])


def _record(outcome: Outcome, origins: dict, seconds: float) -> None:
    """Let results keep what they were made from, and how long that took."""
    for obj in [obj for obj, _ in outcome.results] + outcome.copies:
        obj.reflection_mesh.made_from = origins[obj.reflection_mesh.mirror]
    for obj, _ in outcome.results:
        obj.reflection_mesh.seconds = seconds / len(outcome.results)


def _trees(stage: Stage, kinds: list) -> Steps[None]:
    """Build the trees of those `kinds` that are not kept."""
    for number, kind in enumerate(dict.fromkeys(kinds)):
        if not stage.has(kind):
            start = READING * (0.5 + 0.25 * number)
            yield start, "Building the tree"
            yield from part(core.in_steps(partial(stage.built, kind)), start, 0.25 * READING, "Building the tree")


class REFLECTION_MESH_OT_generate(UsesSettings, SteppedOperator, SettingsOptions, bpy.types.Operator):
    """Make what each mirror shows as an object of its own, as the scene's camera sees it"""

    bl_idname = "reflection_mesh.generate"
    bl_label = "Generate Reflection"
    bl_options = {"REGISTER", "UNDO"}
    uses = SETTINGS + WRITTEN_SETTINGS

    preview: bpy.props.BoolProperty(name="Preview", default=False, options={"SKIP_SAVE"},
                                    description="Until it is lit, show the colours of what is reflected in the "
                                    "mirror's tint, untouched by lamps: on where a button is pressed")
    attributes: option("attributes")
    collect: bpy.props.BoolProperty(name="In a Collection", default=False, options={"SKIP_SAVE"},
                                    description="A new result goes into the collection Reflections, instead of those "
                                    "of its mirror: on where a button is pressed")
    select_alone: bpy.props.BoolProperty(name="Select Alone", default=False, options={"SKIP_SAVE"},
                                         description="Only the result is selected afterwards: on where a button is "
                                         "pressed")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror, polls.has_camera)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set:
        # so that whoever pressed a button sees the result; scripts get what they ask for
        for name in FOR_THE_EYE:
            if not self.properties.is_property_set(name):
                setattr(self, name, True)
        return SteppedOperator.invoke(self, context, event)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        chosen, wanted = choose(context), self.wanted(context)
        outcome = yield from generation(context, chosen, wanted, self.preview, Manners(self.collect))
        self.show_used(wanted, chosen.mirrors)
        lacks = scene_shortcomings(context, chosen, wanted)
        # the view layer knows new objects only from its next update on
        context.view_layer.update()
        if self.select_alone:
            for obj in context.selected_objects:
                obj.select_set(False)
        for obj, _ in outcome.results:
            if obj.name in context.view_layer.objects:
                obj.select_set(True)
                context.view_layer.objects.active = obj
        tell_done(self, [*outcome.news, outcome.summary(time.perf_counter() - started)],
                  outcome.remarks + lacks)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_generate)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_generate)
