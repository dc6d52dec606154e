"""The operator that lights reflections: their results look as the mirrors do."""
from __future__ import annotations

import time
from collections.abc import Callable

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..baking import KeptMap, are_few, baked, can_be_baked, kept_map
from ..faults import AllOrNothing, SteppedOperator, Steps, Undivided, part, tell
from ..lamps import lamps_before, lamps_that_show
from ..lighting import (
    Window,
    beside_lamps,
    is_overexposed,
    is_plain,
    light_scene,
    needs_light,
    new_export_image,
    new_image,
    new_material,
    paper_white_of,
    pixel_kernel,
    show_light,
    show_object_light,
    texels_of,
    white_of,
)
from ..mirror_part import LaterMirrors, Surroundings, new_object_material
from ..reading import (
    has_linked_results,
    is_opaque,
    moves,
    read_scene,
    read_view,
    seen_in,
    vectors,
    with_copies,
)
from ..reading.materials import reflecting_materials
from ..settings import LIGHT_SETTINGS, SAMPLES, UsesSettings, option
from ..writing import forget_mesh, place_of
from . import polls
from .clear import chosen_results
from .light_remarks import summary, unlike_the_mirror
from .lit_groups import for_the_camera, with_mirrors

NAME = "Reflection Light"
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

    Yields (fraction, stage), before each render an `Undivided` one; closed at any step it leaves no trace.

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
    everything, shows, lamps = [], [], lamps_that_show(context)
    with AllOrNothing() as whole:
        for number, (results, samples, kind) in enumerate(groups):
            lit = [result for result in results if every or needs_light(result) or lamps_before(result, lamps)]
            if not lit:
                continue
            with_objects = kind == "OBJECTS" or (kind == "AUTO" and _view_moves(context, lit) and can_be_baked(lit)
                                                 and are_few(lit))
            steps = (_on_objects(context, lit, view, samples, whole) if with_objects
                     else _in_picture(context, lit, view, samples, whole, lamps_apart))
            shows.append((yield from part(steps, number / len(groups), 1.0 / len(groups))))
            everything += lit
        meshes: dict = {}
        for result in everything:
            meshes.setdefault(result.data, []).append(result)
        for mesh, linked in meshes.items():
            _keep_apart(mesh, linked, whole)
        for show in shows:
            yield from part(show(), 1.0, 0.0)
        for linked in meshes.values():
            _stay_linked(linked, whole)
    return everything


def _view_moves(context: bpy.types.Context, lit: list) -> bool:
    """Whether the camera or a mirror is animated."""
    return any(map(moves, [context.scene.camera, *(result.reflection_mesh.mirror for result in lit)]))


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


def _in_picture(context: bpy.types.Context, lit: list, view: View, samples: int, whole: AllOrNothing,
                lamps_apart: bool) -> Steps[Callable[[], Steps[None]]]:
    """Render what `lit` show of the picture; returns what lets them show it."""
    window = Window.around(view, np.concatenate([_on_the_mirror(result) for result in lit]))
    if window is None:
        raise ReflectionError("The camera sees none of the reflections: generate them again for this view.")
    with light_scene(context, lit, window) as scene:
        yield 0.02, Undivided("Cycles renders the light")
        light = scene.light(samples)
        yield 0.9, Undivided("Cycles renders what reflections cover")
        coverage, shining = scene.coverage()
    # what was clear for a while counts as changed only now
    context.view_layer.update()
    cycles = context.scene.cycles
    kernel = pixel_kernel(cycles.pixel_filter_type, cycles.filter_width)
    opacity = light[..., 3] if scene.alone else None
    white = white_of(context.scene)
    texels = yield from part(texels_of(light[..., :3], coverage, kernel, white, opacity), 0.93, 0.04)
    image, apart = (yield from part(new_image(NAME, texels, whole), 0.97, 0.01)), None
    if lamps_apart and is_overexposed(light[..., :3], shining, paper_white_of(context.scene)):
        # what shines ends where its faces do, however bright it is: between texels it could not
        apart = []
        for name, part_of in (("Matte", beside_lamps(coverage, shining)), ("Shining", shining)):
            found = yield from part(texels_of(light[..., :3], part_of, kernel, white, opacity, name == "Shining"), 0.98,
                                    0.005)
            apart.append((yield from part(new_image(f"{NAME} {name}", found, whole), 0.985, 0.0)))
    export_image = yield from part(new_export_image(f"{NAME} Export", texels, whole), 0.99, 0.01)

    def show() -> Steps[None]:
        material = new_material(NAME, image, export_image, texels, whole, apart)
        for result in lit:
            yield from show_light(result, material, view, window, whole)
    return show


def _on_the_mirror(result: bpy.types.Object) -> np.ndarray:
    """Places (n, 3) of a result's points where the camera sees them in the mirror: any on the same line of sight do."""
    if "mirror_position" in result.data.attributes:
        return vectors(result.data, "mirror_position")
    to_world = np.array(place_of(result))
    return vectors(result.data, "position") @ to_world[:3, :3].T + to_world[:3, 3]


def _on_objects(context: bpy.types.Context, lit: list, view: View, samples: int, whole: AllOrNothing
                ) -> Steps[Callable[[], Steps[None]]]:
    """Bake the objects that `lit` show; returns what lets them show it."""
    if not can_be_baked(lit):
        raise ReflectionError("A reflection of points, or of objects that have been deleted, or one that knows only "
                              "what is seen, has no light on objects: light it in the picture.")
    is_seen = seen_in(context)
    sources = [obj for obj in dict.fromkeys(entry.object for result in lit for entry in result.reflection_mesh.sources)
               if is_seen(obj)]
    scene = read_scene(context.evaluated_depsgraph_get(), sources)
    light = yield from part(baked(context, lit, view, scene, samples), 0.02, 0.93)
    image = yield from part(new_image(NAME, light.texels, whole), 0.95, 0.05)
    # what was hidden for a while counts as changed only now
    context.view_layer.update()
    opaque, lamps = all(map(is_opaque, scene.materials)), lamps_that_show(context)

    def show() -> Steps[None]:
        light_map = kept_map(NAME, light.uv)
        whole.undo(bpy.data.meshes.remove, light_map)
        for result in lit:
            around = Surroundings(result.reflection_mesh.mirror, lamps_before(result, lamps),
                                  LaterMirrors.of(result, context.scene.objects), not result.reflection_mesh.window)
            material = new_object_material(NAME, image, _mirror_materials(result), opaque, around, whole)
            yield from show_object_light(result, material, view, scene, KeptMap(light_map, light.sheets, light.dull),
                                         whole)
    return show


def _mirror_materials(result: bpy.types.Object) -> list[bpy.types.Material | None]:
    """The materials of a result's mirror that reflect; None where all of the light is shown."""
    reflecting = reflecting_materials(result.reflection_mesh.mirror)
    return [None if is_plain(one) else one for one in reflecting] if not all(map(is_plain, reflecting)) else [None]


class REFLECTION_MESH_OT_light(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Let the reflections look as the mirrors do, with the scene's lamps, materials and the mirrors' own tint"""

    bl_idname = "reflection_mesh.light"
    bl_label = "Light Reflection"
    bl_options = {"REGISTER", "UNDO"}

    uses, renamed = LIGHT_SETTINGS, {"light_samples": "samples", "light_kind": "kind"}

    samples: option("light_samples", name="Samples")
    kind: option("light_kind")
    every: bpy.props.BoolProperty(name="Even Those That Need None", default=False, options={"SKIP_SAVE"},
                                  description="Also reflections that look right as they are: for files that carry "
                                  "pictures but not all materials, as glTF and USD")

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
        for sentence in [summary(lit, time.perf_counter() - started), *advice, *unlike_the_mirror(context.scene, lit)]:
            tell(self, {"INFO"}, sentence)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_light)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_light)
