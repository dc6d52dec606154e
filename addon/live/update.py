"""Update all stale results with one click, whatever is selected. Results that were lit are lit again."""
import time
from dataclasses import replace

import bpy

from ...core import ReflectionError
from ..faults import SteppedOperator, Steps, listed, one_or_more, part, tell, tell_done
from ..freshness import why_light_differs, why_light_is_stale, why_stale
from ..lighting import is_lit
from ..operators import polls
from ..operators.generate import IN_OBJECT_MODE, generation
from ..operators.light import lit_again
from ..operators.light_remarks import summary
from ..operators.write_results import Manners
from ..settings import Wanted
from .kept import abandoned_light, abandoned_results, groups, kept_light, kept_results, why_not_kept
from .thrown import light_groups, made_anew

GENERATING = 0.3    # share of the work if results are lit again
NOTHING_STALE = "No reflection is stale."


class REFLECTION_MESH_OT_update(SteppedOperator, bpy.types.Operator):
    """Update the reflections and caustics that are out of date"""

    bl_idname = "reflection_mesh.update"
    bl_label = "Update Reflections"
    bl_options = {"REGISTER", "UNDO"}

    # no annotation: Blender takes those of an operator for its properties
    _pressed = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_camera,
                            polls.has_what_is_kept_right(NOTHING_STALE))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set:
        self._pressed = True
        return SteppedOperator.invoke(self, context, event)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        stale = [obj for obj in kept_results(context) if why_stale(context, obj)]
        lit = list(filter(is_lit, kept_results(context)))
        outdated = {obj for obj in lit if why_light_differs(context, obj)}
        chosen = [group for group in groups(context)
                  if any(obj.reflection_mesh.mirror == one.mirror for obj in stale for one in group.assemblies)]
        lost = _lost(context)
        thrown = [obj for obj in kept_light(context) if obj not in lost and why_light_is_stale(context, obj)]
        if not stale and not outdated and not thrown and not lost:
            tell(self, {"INFO"}, NOTHING_STALE)
        told: list = []
        remarks = [f"'{obj.name}' cannot be made anew: {why}." for obj, why in lost.items()]
        remarks += [f"{obj.name}: {why}" for obj in stale if (why := why_not_kept(context, obj))]
        # to light takes longer than to generate
        share = GENERATING if lit else 1.0
        for number, group in enumerate(chosen):
            steps = generation(context, group, Wanted(context.scene), manners=Manners(preview_unlit=self._pressed))
            outcome = yield from part(steps, share * number / len(chosen), share / len(chosen))
            told.append(replace(outcome, unlit=[]).summary(time.perf_counter() - started))
            remarks += outcome.remarks
        yield from self._light(context, thrown)
        # new results have lost light that no longer fits
        unlit = [obj for obj in lit if obj in outdated or not is_lit(obj)]
        remarks += yield from part(self._relight(context, unlit, told), share, 1.0 - share)
        tell_done(self, told + [self._summary(thrown)] * bool(thrown), remarks)

    def _relight(self, context: bpy.types.Context, results: list, told: list) -> Steps[list]:
        """Light results with the settings of the last time. Append to `told`; return sentences on results that could
        not be lit.
        """
        if not results:
            return []
        started = time.perf_counter()
        try:
            lit = yield from lit_again(context, results)
        except ReflectionError as error:
            return [str(error)]
        told.append(summary(lit, time.perf_counter() - started))
        return []

    def _light(self, context: bpy.types.Context, lit: list) -> Steps[None]:
        """Update stale caustics, together with others on the same objects."""
        pairs, wanted = {(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp) for obj in lit}, Wanted(context.scene)
        for group in light_groups(context):
            if pairs & group.pairs:
                yield from made_anew(context, group, {mirror: wanted(mirror) for mirror, _ in group.pairs})

    def _summary(self, lights: list) -> str:
        faces = one_or_more(sum(len(light.data.polygons) for light in lights), "1 face", "{count} faces")
        seconds = sum(light.reflection_mesh.seconds for light in lights)
        return f"{listed(light.name for light in lights)}: {faces} of light, {seconds:.2f} s"


def _lost(context: bpy.types.Context) -> dict:
    """Return the results that cannot be updated because their mirror or lamp is deleted, with a message on each."""
    found = {obj: why_stale(context, obj) for obj in abandoned_results(context)}
    return found | {obj: why_light_is_stale(context, obj) for obj in abandoned_light(context)}


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_update)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_update)
