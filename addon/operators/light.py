"""The operator that lights reflections: their results look as the mirrors do."""
from __future__ import annotations

import time

import bpy

from ...core import ReflectionError
from ..baking import are_few, can_be_baked
from ..faults import AllOrNothing, SteppedOperator, Steps, part, tell
from ..freshness import lit_record, lit_with
from ..lamps import lamps_before, lamps_that_show
from ..lighting import needs_light, update_mattes
from ..reading import has_linked_results, mirrors_of, moves, read_view, with_copies
from ..settings import LIGHT_SETTINGS, SAMPLES, UsesSettings, Wanted, option
from ..writing import forget_mesh
from . import polls
from .clear import chosen_results
from .light_remarks import summary, unlike_the_mirror
from .lit_groups import for_the_camera, with_mirrors
from .made_light import light_in_picture, light_on_objects

IN_OBJECT_MODE = "Reflections are lit in Object Mode: leave the present mode first."
FOR_THIS_FRAME = ("So many objects are reflected that their light was made for this frame alone: bake frames for an "
                  "animation, or choose Light: Objects to keep it while things move.")
NOTHING_TO_LIGHT = "The scene has no reflection to light: generate one first."
LINKED_TO_LIGHT = ("The reflections are linked from another file: light them in that file, save it, and reload the "
                   "library here.")


def lighting(context: bpy.types.Context, results: list, samples: int = SAMPLES, kind: str = "AUTO",
             every: bool = False, lamps_apart: bool = True) -> Steps[list]:
    """Let `results` show the light that their mirrors show.

    In the picture, Cycles renders the mirrors as they are, once, and each result shows that where the camera sees it;
    on the objects, Cycles bakes these, and each result shows them by what its mirror is.

    Yields (fraction, stage), of renders as `rendering.shown_while`; closed at any step it leaves no trace.

    Parameters
    ----------
    samples : int
        Per pixel, or texel.
    kind : {'AUTO', 'PICTURE', 'OBJECTS'}
    every : bool
        Also those that look right as they are.
    lamps_apart : bool
        Whether what shines and is overexposed has texels of its own: frames that are baked have one picture each.

    Returns
    -------
    lit : list of bpy.types.Object
        Those of the results that did not look right as they were, or every one.

    Raises
    ------
    ReflectionError
        Where there is nothing to light, or a render is cancelled; nothing has changed then.
    """
    return (yield from lighting_groups(context, [(results, samples, kind)], every, lamps_apart))


def lighting_groups(context: bpy.types.Context, groups: list[tuple[list, int, str]], every: bool = False,
                    lamps_apart: bool = True) -> Steps[list]:
    """As `lighting`, for several groups (results, samples, kind): all of them are lit, or none."""
    if context.mode != "OBJECT":
        raise ReflectionError(IN_OBJECT_MODE)
    if not any(results for results, _, _ in groups):
        raise ReflectionError(LINKED_TO_LIGHT if has_linked_results() else NOTHING_TO_LIGHT)
    yield 0.0, "Reading the scene"
    view = read_view(context)
    groups = for_the_camera(context.scene.camera, with_mirrors(context, groups))
    everything, shows, records, lamps = [], [], {}, lamps_that_show(context)
    with AllOrNothing() as whole:
        for number, (results, samples, kind) in enumerate(groups):
            lit = [result for result in results if every or needs_light(result) or lamps_before(result, lamps)]
            if not lit:
                continue
            records |= lit_record(context, view, lit, {"samples": samples, "kind": kind, "every": every})
            with_objects = kind == "OBJECTS" or (kind == "AUTO" and _view_moves(context, lit) and can_be_baked(lit)
                                                 and are_few(lit))
            steps = (light_on_objects(context, lit, view, samples, whole) if with_objects
                     else light_in_picture(context, lit, view, samples, whole, lamps_apart))
            shows.append((yield from part(steps, number / len(groups), 1.0 / len(groups))))
            everything += lit
        meshes: dict = {}
        for result in everything:
            meshes.setdefault(result.data, []).append(result)
        for mesh, linked in meshes.items():
            _keep_apart(mesh, linked, whole)
        for show in shows:
            yield from part(show(), 1.0, 0.0)
        for result, text in records.items():
            result.reflection_mesh.lit_from = text
        for linked in meshes.values():
            _stay_linked(linked, whole)
    update_mattes(context)
    return everything


def lit_again(context: bpy.types.Context, results: list) -> Steps[list]:
    """Light each of the results with the settings that it was lit with, else with those of the file."""
    groups: dict = {}
    for result in results:
        known = {**dict(zip(("samples", "kind"), Wanted(context.scene).lights([result])[0][1:])), **lit_with(result)}
        key = int(known["samples"]), str(known["kind"])
        groups.setdefault(bool(known.get("every")), {}).setdefault(key, []).append(result)
    lit = []
    for number, (every, own) in enumerate(groups.items()):
        steps = lighting_groups(context, [(group, *key) for key, group in own.items()], every)
        lit += yield from part(steps, number / len(groups), 1.0 / len(groups))
    return lit


def _view_moves(context: bpy.types.Context, lit: list) -> bool:
    """Whether the camera or a mirror is animated."""
    return any(map(moves, [context.scene.camera, *(mirror for result in lit for mirror in mirrors_of(result))]))


def _keep_apart(mesh: bpy.types.Mesh, linked: list, whole: AllOrNothing) -> None:
    """Let none of several results that have one mesh write it: each writes its own, and can go back to this."""
    if len(linked) > 1 and mesh.library is None:
        whole.after(forget_mesh, mesh)
        for step in (whole.undo, whole.after):
            step(setattr, mesh, "use_fake_user", mesh.use_fake_user)
        mesh.use_fake_user = True


def _stay_linked(linked: list, whole: AllOrNothing) -> None:
    """Let results that had one mesh have one again."""
    for result in linked[1:]:
        whole.undo(setattr, result, "data", result.data)
        whole.after(forget_mesh, result.data)
        result.data = linked[0].data


class REFLECTION_MESH_OT_light(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Render the light that the mirrors show and put it on the reflections"""

    bl_idname = "reflection_mesh.light"
    bl_label = "Light Reflection"
    bl_options = {"REGISTER", "UNDO"}

    uses, renamed = LIGHT_SETTINGS, {"light_samples": "samples", "light_kind": "kind"}

    samples: option("light_samples", name="Samples")
    kind: option("light_kind")
    every: bpy.props.BoolProperty(name="Light All", default=False, options={"SKIP_SAVE"},
                                  description="Also light reflections that look right without it, for files that "
                                              "carry images but not all materials, such as glTF and USD")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE),
                            polls.has_result(NOTHING_TO_LIGHT, LINKED_TO_LIGHT), polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        results, wanted = with_copies(context, chosen_results(context)), self.wanted(context)
        lights = wanted.lights(results)
        lit = yield from lighting_groups(context, lights, self.every)
        advice = [FOR_THIS_FRAME] * any(
            kind == "AUTO" and set(group) & set(lit) and _view_moves(context, group) and not are_few(group)
            for group, _, kind in lights)
        self.show_used(wanted, [result.reflection_mesh.mirror for result in results])
        # what is told last stays in the status bar
        for sentence in [summary(lit, time.perf_counter() - started), *advice, *unlike_the_mirror(context, lit)]:
            tell(self, {"INFO"}, sentence)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_light)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_light)
