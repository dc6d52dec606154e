"""The operator that lights reflections: their results look as the mirrors do."""
from __future__ import annotations

import time

import bpy

from ...core import ReflectionError
from ..faults import AllOrNothing, SteppedOperator, Steps, part, tell
from ..freshness import lit_record, lit_with
from ..lamps import lamps_before, lamps_that_show
from ..lighting import needs_light, update_mattes
from ..reading import has_linked_results, mirrors_of, read_view, with_copies
from ..settings import LIGHT_SETTINGS, SAMPLES, UsesSettings, Wanted, option
from . import polls
from .clear import chosen_results
from .light_remarks import summary, unlike_the_mirror
from .lit_groups import for_the_camera, with_mirrors
from .made_light import light_results

IN_OBJECT_MODE = "Reflections are lit in Object Mode: leave the present mode first."
NOTHING_TO_LIGHT = "The scene has no reflection to light: generate one first."
LINKED_TO_LIGHT = ("The reflections are linked from another file: light them in that file, save it, and reload the "
                   "library here.")


def lighting(context: bpy.types.Context, results: list, samples: int = SAMPLES, every: bool = False,
             flat: bool = False) -> Steps[list]:
    """Let `results` show the light that their mirrors show: Cycles shades what each of their points shows.

    Yields (fraction, stage), of renders as `rendering.shown_while`; closed at any step it leaves no trace.

    Parameters
    ----------
    samples : int
        Light paths for each pixel.
    every : bool
        Also those that look right as they are. In files for other programs they do not.
    flat : bool
        Put what the mirror makes of the light into the picture too, for materials that show nothing but that picture.

    Returns
    -------
    lit : list of bpy.types.Object
        Those of the results that did not look right as they were, or every one.

    Raises
    ------
    ReflectionError
        If there is nothing to light, or a render is cancelled; nothing has changed then.
    """
    return (yield from lighting_groups(context, [(results, samples)], every, flat))


def lighting_groups(context: bpy.types.Context, groups: list[tuple[list, int]], every: bool = True,
                    flat: bool = False) -> Steps[list]:
    """Light several groups (results, samples) as `lighting` does: all of them, or none."""
    if context.mode != "OBJECT":
        raise ReflectionError(IN_OBJECT_MODE)
    if not any(results for results, _ in groups):
        raise ReflectionError(LINKED_TO_LIGHT if has_linked_results() else NOTHING_TO_LIGHT)
    yield 0.0, "Reading the scene"
    view = read_view(context)
    groups = for_the_camera(context.scene.camera, with_mirrors(context, groups))
    everything, shows, records, lamps = [], [], {}, lamps_that_show(context)
    with AllOrNothing() as whole:
        for number, (results, samples) in enumerate(groups):
            lit = [result for result in results
                   if every or needs_light(result) or lamps_before(result.data, lamps, mirrors_of(result))]
            if not lit:
                continue
            records |= lit_record(context, view, lit, {"samples": samples})
            steps = light_results(context, lit, view, samples, whole, flat)
            shows.append((yield from part(steps, number / len(groups), 1.0 / len(groups))))
            everything += lit
        yield 1.0, "Writing"
        for show in shows:
            show()
        for result, text in records.items():
            result.reflection_mesh.lit_from = text
    update_mattes(context)
    return everything


def lit_again(context: bpy.types.Context, results: list) -> Steps[list]:
    """Light each of the results with the samples that it was lit with, else with those of the file."""
    groups: dict = {}
    for result in results:
        known = {"samples": Wanted(context.scene).lights([result])[0][1], **lit_with(result)}
        groups.setdefault(int(known["samples"]), []).append(result)
    return (yield from lighting_groups(context, [(group, samples) for samples, group in groups.items()]))


class REFLECTION_MESH_OT_light(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Render the light that the mirrors show and put it on the reflections"""

    bl_idname = "reflection_mesh.light"
    bl_label = "Light Reflection"
    bl_options = {"REGISTER", "UNDO"}

    uses, renamed = LIGHT_SETTINGS, {"light_samples": "samples"}

    samples: option("light_samples", name="Samples")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE),
                            polls.has_result(NOTHING_TO_LIGHT, LINKED_TO_LIGHT), polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        results, wanted = with_copies(context, chosen_results(context)), self.wanted(context)
        lights = wanted.lights(results)
        lit = yield from lighting_groups(context, lights)
        self.show_used(wanted, [result.reflection_mesh.mirror for result in results])
        # what is told last stays in the status bar
        for sentence in [summary(lit, time.perf_counter() - started), *unlike_the_mirror(context, lit)]:
            tell(self, {"INFO"}, sentence)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_light)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_light)
