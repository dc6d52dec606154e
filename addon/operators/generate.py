"""The main job: read the scene, reflect it in each mirror, write one object per mirror."""
from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

import bpy

from ... import core
from ..faults import SteppedOperator, Steps, gathered, part, tell_done
from ..freshness import light_difference, origin_of, record_of, settings_of
from ..reading import (
    Assembly,
    DiffuseScene,
    MirrorSurface,
    NothingSeen,
    Participants,
    choose,
    every_result_of,
    is_part,
    lines_drawn,
    opacities_of,
    read_view,
)
from ..settings import (
    SETTINGS,
    WRITTEN_SETTINGS,
    SettingsOfMirrors,
    SettingsOptions,
    UsesSettings,
    of_each,
    option,
    written_of,
)
from ..standing import Kept, Stage
from ..writing import MeshArrays, Reflection, mesh_arrays, nearer, point_arrays, what_is_in_the_way
from . import polls
from .assembled import assembled
from .pressed import ProtectsResults
from .rounding import rounding_remarks
from .shortcomings import (
    NONE_SEEN,
    TOO_CLOSE,
    Refused,
    left_out,
    rough_shortcomings,
    scene_shortcomings,
    shortcomings,
    too_close,
    window_shortcomings,
)
from .write_results import Manners, Outcome, write_results

# share of the work that reading takes, before the mirrors are reflected one by one
READING = 0.1
IN_OBJECT_MODE = "Reflections are generated in Object Mode: leave the present mode first."


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
    started = time.perf_counter()
    _begin(context)
    yield 0.0, "Reading the scene"
    told, view = left_out(context, chosen), view or read_view(context)
    kept = Kept.of(depsgraph := context.evaluated_depsgraph_get())
    mirrors = assembled(context, chosen, settings)
    mirrors, meshes, faceless = _with_faces(mirrors, *kept.looked_at(depsgraph, mirrors, chosen.diffuse))
    own = [of_each(settings)(one.mirror) for one in mirrors]
    sources, lines = chosen.diffuse + chosen.waiting, lines_drawn(context.scene)
    origins = _origins(depsgraph, view, mirrors, sources)
    unfit = _unfit(context, view, [one.mirror for one in mirrors], sources)
    joined = partial(kept.joined, mirrors, chosen.diffuse, *meshes)
    stage = yield from part(core.in_steps(joined), 0.0, 0.5 * READING, "Reading the scene")
    scene, surfaces, opacity = stage.scene, stage.surfaces, opacities_of(depsgraph, stage.scene)
    told += faceless + rough_shortcomings([one.mirror for one in mirrors], surfaces)
    kinds = [core.PointTree if one.method == "POINTS" else core.SceneTree for one in own]
    yield from _trees(stage, kinds)
    prepared, refused, unseen, lacks, share = [], [], [], [], (1.0 - READING) / len(surfaces)
    for index, (joint, surface) in enumerate(zip(mirrors, surfaces)):
        mirror = joint.mirror
        steps = core.reflection_steps(view, surface.mesh, stage.built(kinds[index]), own[index], opacity=opacity)
        try:
            result = yield from part(steps, READING + index * share, share, mirror.name)
            if not len(result.positions):
                raise core.ReflectionError(TOO_CLOSE) if too_close(result, scene.materials) else \
                    core.NothingInView(NONE_SEEN)
            if own[index].placement == "VIRTUAL":
                found = what_is_in_the_way(context, view, result, chosen.mirrors)
                lacks += window_shortcomings(joint, found)
                result = nearer(view, result, found)
        except core.ReflectionError as error:
            refused.append(f"{mirror.name}: {error}")
            unseen += refused[-1:] * isinstance(error, core.NothingInView)
            continue
        lacks += shortcomings(mirror.name, result, scene.materials)
        written = partial(_written, result, scene, (surface, surfaces), view, lines)
        result, arrays = yield from part(core.in_steps(written), READING + (index + 1) * share, 0.0,
                                         f"{mirror.name}: Writing")
        prepared.append(Reflection(joint, context.scene.camera, sources, result, arrays, view.resolution, own[index],
                                   *(written_of(settings, mirror, context.scene, name)
                                     for name in ("attributes", "world_faces"))))
    if not prepared:
        raise NothingSeen(refused[0]) if unseen == refused else Refused(refused)
    kept.within(max(one.maximum_memory for one in own))
    yield 1.0, "Writing"
    outcome = write_results(context, prepared, view, scene, replace(manners, preview=preview), unfit)
    _record(outcome, origins, time.perf_counter() - started)
    return replace(outcome, remarks=told + lacks + outcome.remarks + refused,
                   lacks=lacks + [sentence for sentence in refused if sentence not in unseen],
                   read=(view, {one.mirror: surface for one, surface in zip(mirrors, surfaces)}, scene))


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


def _begin(context: bpy.types.Context) -> None:
    """Raise an error outside Object Mode; let the core use as many threads as renders do."""
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    core.use_threads(context.scene.render.threads)


def _with_faces(mirrors: list[Assembly], of_mirrors: list, placed: list) -> tuple[list, tuple, list[str]]:
    """Return the mirrors without those that have no faces, as curves that others follow, unless none has; their meshes
    and those of the scene; and sentences on what has no faces."""
    if not any(of_mirrors):
        return mirrors, (of_mirrors, placed), []
    faceless = []
    for mirror, own in zip(mirrors, of_mirrors):
        there = {owner for item in own for owner in item.owners.tolist()}
        faceless += [obj for number, obj in enumerate(mirror.parts) if number not in there and not is_part(obj)]
    return ([mirror for mirror, own in zip(mirrors, of_mirrors) if own], ([own for own in of_mirrors if own], placed),
            [f"Left out because it has no faces: '{obj.name}'." for obj in faceless])


def _origins(depsgraph: bpy.types.Depsgraph, view: core.View, mirrors: list[Assembly], sources: list) -> dict:
    """Return what the result of each mirror is made from."""
    return {one.mirror: record_of(origin_of(depsgraph, view, one.members, sources),
                                  settings_of(depsgraph.scene.original, one.mirror)) for one in mirrors}


def _unfit(context: bpy.types.Context, view: core.View, mirrors: list, sources: list) -> dict[bpy.types.Object, str]:
    """Return why light no longer fits, by the results of mirrors that have been lit; empty where it still does."""
    lit = [result for mirror in mirrors for result in every_result_of(context, mirror)
           if result.reflection_mesh.light_material is not None]
    return {result: light_difference(context, view, result, sources, same_view=False) for result in lit}


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
            yield start, "Preparing the scene"
            yield from part(core.in_steps(partial(stage.built, kind)), start, 0.25 * READING, "Preparing the scene")


class REFLECTION_MESH_OT_generate(UsesSettings, ProtectsResults, SteppedOperator, SettingsOptions, bpy.types.Operator):
    """Create an object for each mirror that shows its reflection, as the scene's camera sees it"""

    bl_idname = "reflection_mesh.generate"
    bl_label = "Generate Reflection"
    bl_options = {"REGISTER", "UNDO"}
    uses = SETTINGS + WRITTEN_SETTINGS
    on_if_pressed = ("preview", "collect", "select_alone", "protect")

    preview: bpy.props.BoolProperty(name="Preview", default=False, options={"SKIP_SAVE"},
                                    description="Show the colors of the reflected objects, unaffected by lamps, until"
                                                " the reflection is lit. On if a button is pressed")
    attributes: option("attributes")
    world_faces: option("world_faces")
    join_parts: option("join_parts")
    collect: bpy.props.BoolProperty(name="In a Collection", default=False, options={"SKIP_SAVE"},
                                    description="Put a new result into the collection Reflections instead of the "
                                                "collections of its mirror. On if a button is pressed")
    select_alone: bpy.props.BoolProperty(name="Select Alone", default=False, options={"SKIP_SAVE"},
                                         description="Deselect all other objects afterwards. On if a button is "
                                                     "pressed")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror, polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        chosen, wanted = choose(context), self.wanted(context)
        outcome = yield from generation(context, chosen, wanted, self.preview,
                                        Manners(self.collect, protect=self.protect))
        self.show_used(wanted, chosen.mirrors)
        lacks = scene_shortcomings(context, chosen, wanted)
        # the view layer knows new objects only from its next update on
        context.view_layer.update()
        lacks += rounding_remarks(context, [obj for obj, _ in outcome.results])
        if self.select_alone:
            for obj in context.selected_objects:
                obj.select_set(False)
        for obj, _ in outcome.results:
            if obj.name in context.view_layer.objects:
                obj.select_set(True)
                if not obj.select_get():
                    # clicks pass by it: the mirror is selected in its place
                    obj.reflection_mesh.mirror.select_set(True)
                context.view_layer.objects.active = obj
        tell_done(self, [*gathered(outcome.news), outcome.summary(time.perf_counter() - started)],
                  outcome.remarks + outcome.dropped + lacks)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_generate)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_generate)
