"""The operator that judges reflections and caustics against Cycles."""
from __future__ import annotations

import time

import bpy
import numpy as np

from ...core import ReflectionError, Settings, in_steps
from .. import compat
from ..comparison import (
    LIGHT_PICTURES,
    REFLECTION_PICTURES,
    Renders,
    load_pictures,
    remember,
    render_comparison,
    show_picture,
    write_report,
)
from ..faults import AllOrNothing, BrowsingOperator, Steps, part, still_there, tell
from ..files import chosen_folder, staged
from ..judge import copied_scene
from ..metrics import Measurement, measure, picture_errors, without_packing
from ..reading import Participants, participants, read_view, results_of
from ..settings import SettingsOfMirrors, SettingsOptions, UsesSettings
from ..writing import as_shown
from . import polls
from .clear import clear
from .compare_light import Effort, light_comparison, light_summary
from .generate import generation
from .rounding import rounding_remarks

IN_OBJECT_MODE = "Reflections are compared in Object Mode: leave the present mode first."
# shares of the work: of all of it what generating takes, where something is missing, and of the rest what follows
GENERATING, COPYING, RENDERING, JUDGING = 0.3, 0.02, 0.88, 0.05


def comparison(context: bpy.types.Context, folder: str, samples: int = 16,
               settings: Settings | SettingsOfMirrors = Settings()) -> Steps[dict]:
    """Judge the reflection meshes of the mirrors that take part against Cycles, and write pictures and numbers.

    What stands in the file is judged; a mirror that has no reflection yet gets one first, by `settings`. Everything is
    rendered in a temporary scene of copies: once in materials that emit positions and identities, which gives the truth
    and what is shown at each pixel's centre, and once in the scene's own materials and lights; results that show light
    are, with their mirrors, in the file's own pictures.

    Yields (fraction, stage), of renders as `rendering.shown_while`; closed at any step it leaves no trace.

    Parameters
    ----------
    folder : str
        Absolute path; made where it does not exist.
    samples : int
        Samples per pixel of the two pictures; 0 takes the scene's own sampling, denoising, clamping and bounces.
    settings : core.Settings, or a function that gives those of a mirror
        For reflections that are still to be generated.

    Returns
    -------
    report : dict
        What report.json holds.

    Raises
    ------
    ReflectionError
        Where nothing can be compared, or a render is cancelled; nothing has changed then.
    """
    if context.mode != "OBJECT":
        raise ReflectionError(IN_OBJECT_MODE)
    mirrors, diffuse = participants(context)
    read_view(context)
    earlier = _results(context, mirrors)
    hidden = [result for result in earlier if result.hide_render or not result.visible_get()]
    if hidden:
        raise ReflectionError(f"The reflection '{hidden[0].name}' is hidden: show it in the viewport and in renders.")
    with AllOrNothing() as whole, staged(folder) as scratch:
        started = time.perf_counter()
        yield 0.0, "Reading the scene"
        missing = [mirror for mirror in mirrors if not results_of(context, mirror)]
        shown = as_shown(context.scene)
        if missing:
            yield from part(generation(context, Participants(missing, diffuse, []), settings), 0.0, GENERATING)
        results = _results(context, mirrors)
        if missing:
            # an error or ESC leaves no reflection behind that was made for this comparison alone, and those of other
            # cameras as they were
            whole.undo(shown)
            whole.undo(_clear, context, [result for result in results if result not in earlier])
        done = GENERATING if missing else 0.0
        judged = _judged(context, Participants(mirrors, diffuse, []), results, scratch, samples, started)
        return (yield from part(judged, done, 1.0 - done))


def _results(context: bpy.types.Context, mirrors: list) -> list:
    return list(dict.fromkeys(result for mirror in mirrors for result in results_of(context, mirror)))


def _clear(context: bpy.types.Context, results: list) -> None:
    clear(context, still_there(results))


def _judged(context: bpy.types.Context, chosen: Participants, results: list, folder: str, samples: int,
            started: float) -> Steps[dict]:
    """Render, measure and write the report of what stands in the file."""
    yield 0.0, "Copying the scene"
    with copied_scene(context, chosen.mirrors, chosen.diffuse, results) as copied:
        renders = yield from part(render_comparison(context, copied, chosen.diffuse, results, samples), COPYING,
                                  RENDERING)
        mirror, pictures = renders.mirror, renders.pictures
        done = COPYING + RENDERING
        yield done, "Measuring displacements"
        measurement, exact = yield from part(in_steps(lambda: _measured(renders)), done, 0.0, "Measuring displacements")
        masks = {"mirror": measurement.judged, "all": np.ones_like(mirror)}
        picture = yield from part(in_steps(lambda: picture_errors(pictures.reference, pictures.result, masks)), done,
                                  JUDGING, "Comparing the pictures")
        done += JUDGING
        noise = yield from part(
            in_steps(lambda: pictures.again is not None and picture_errors(pictures.reference, pictures.again, masks)),
            done, 0.0, "Comparing the pictures")
        report = {
            "blender": bpy.app.version_string,
            "resolution": [mirror.shape[1], mirror.shape[0]],
            "mirrors": [obj.name for obj in chosen.mirrors], "diffuse": [obj.name for obj in chosen.diffuse],
            "results": [obj.name for obj in results],
            **measurement.numbers,
            "without_packed_normals": exact,
            "picture": {**picture, "samples": samples, "noise": noise or None},
            "generate_seconds": sum(obj.reflection_mesh.seconds for obj in results),
            "render_seconds": pictures.seconds,
            "seconds": time.perf_counter() - started,
        }
        yield from part(write_report(folder, copied.scene, pictures, measurement, report), done, 1.0 - done)
    return report


def _measured(renders: Renders) -> tuple[Measurement, dict | None]:
    """Return the errors of the mesh's picture, and those without the rounding of normals, or None."""
    pictures = renders.mirror, renders.bent, renders.truth
    return (measure(*pictures, renders.shown),
            renders.exact and without_packing(*pictures, renders.exact, renders.shown))


WHAT = (("AUTO", "Automatic", "Caustics if they are selected or if the mirrors have no reflections, otherwise "
                                     "reflections"),
        ("REFLECTIONS", "Reflections", "What the camera sees in the mirrors"),
        ("CAUSTICS", "Caustics", "Light of lamps that the mirrors reflect onto other objects"))
REFERENCE, RAYS = 512, 400_000


def means_caustics(context: bpy.types.Context) -> bool:
    """Return True if the selection, or the existing results of the mirrors that take part, point to caustics."""
    chosen = [obj for obj in context.view_layer.objects
              if obj.select_get() or obj == context.view_layer.objects.active]
    roles = {obj.reflection_mesh.role for obj in chosen}
    if roles & {"CAUSTICS", "REFLECTION"}:
        return "REFLECTION" not in roles
    thrown = {obj.reflection_mesh.mirror for obj in context.view_layer.objects
              if obj.reflection_mesh.role == "CAUSTICS"}
    if not thrown:
        return False
    try:
        mirrors, _ = participants(context)
    except ReflectionError:
        return True
    return not any(results_of(context, mirror) for mirror in mirrors) and not thrown.isdisjoint(mirrors)


class REFLECTIONMESH_OT_compare(UsesSettings, BrowsingOperator, SettingsOptions, bpy.types.Operator):
    """Compare reflections or caustics with Cycles, and write images and errors to a folder"""

    bl_idname = "reflection_mesh.compare"
    bl_label = "Compare with Cycles"
    bl_options = {"REGISTER", "UNDO"}

    filepath: bpy.props.StringProperty(name="Folder", description="Folder for the pictures and the report",
                                       default="//reflection comparison", subtype="FILE_PATH",
                                       options=compat.RELATIVE_PATH)
    samples: bpy.props.IntProperty(name="Samples", default=16, min=0, soft_max=1024,
                                   options={"SKIP_SAVE"},
                                   description="Samples per pixel of the images. 0 uses the scene's samples")
    what: bpy.props.EnumProperty(name="What", items=WHAT, options={"SKIP_SAVE"},
                                description="What is compared with Cycles")
    converged: bpy.props.IntProperty(name="Reference Samples", default=REFERENCE, min=1, soft_max=65536,
                                     options={"SKIP_SAVE"},
                                     description="Samples per pixel of the Cycles image that caustics are compared "
                                                 "with")
    rays: bpy.props.IntProperty(name="Rays", default=RAYS, min=1, soft_max=100_000_000,
                               options={"SKIP_SAVE"},
                                description="Number of rays that are traced for each caustics object")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror_or_caustics,
                            polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        folder, wanted = chosen_folder(self.filepath), self.wanted(context)
        if self.what == "CAUSTICS" or (self.what == "AUTO" and means_caustics(context)):
            effort = Effort(self.samples or context.scene.cycles.samples, self.converged, self.rays)
            report = yield from light_comparison(context, folder, effort)
            told, pictures = light_summary(report, folder), LIGHT_PICTURES
        else:
            report = yield from comparison(context, folder, self.samples, wanted)
            self.show_used(wanted)
            told, pictures = summary(report, folder), REFLECTION_PICTURES
        remember(context.scene, report, folder)
        for sentence in remarks_on(context, report):
            tell(self, {"WARNING"}, sentence)
        if not bpy.app.background:
            show_picture(context.window_manager, load_pictures(folder, pictures)[-1])
        tell(self, {"INFO"}, told)


def remarks_on(context: bpy.types.Context, report: dict) -> list[str]:
    """Return what to know of a report's numbers."""
    results = map(context.scene.objects.get, report["results"])
    return rounding_remarks(context, [result for result in results if result is not None])


def summary(report: dict, folder: str) -> str:
    """Return the report in one sentence."""
    displacement, coverage = report["displacement_px"], report["coverage_percent"]
    if not report["judged_pixels"]:
        return f"The camera sees no mirror whose reflection could be judged; pictures in {folder}"
    if displacement["p99"] is None:
        return f"The reflection shows nothing that could be measured; pictures in {folder}"
    return (f"Displacement {displacement['median']:.3f} px (median), {displacement['p99']:.3f} px (99 %); "
            f"holes, spill and wrong layer {coverage['all']:.3f} % of the mirror; pictures in {folder}")


def register() -> None:
    bpy.utils.register_class(REFLECTIONMESH_OT_compare)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTIONMESH_OT_compare)
