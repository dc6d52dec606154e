"""A temporary scene in which the mirrors show their own light: the user's, with settings that may be changed."""
from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat
from ..faults import still_there
from ..reading import goes_by_name, is_linked, is_opaque, materials_of, mirrors_of, read_view
from ..reading.materials import all_materials_of, is_exact
from ..rendering import (
    SEEN,
    OwnCollections,
    Renders,
    copied_scene,
    crop_to,
    denoise,
    look_through,
    only_the_picture,
    put_swift_world,
    rendering,
    sharp_camera,
)
from .clear_air import clear_air, is_of_fog
from .cutting import cut_through
from .picture import Window, on_the_mirror, shining_slots
from .standing_before import standing_before

COVERAGE_SAMPLES = 64  # where a result ends; elsewhere as few tell that it does not
INNER_SAMPLES, UNEVEN = 8, 0.01
STEADY_SAMPLES = 64  # from which on what sharp mirrors show has albedo and normals with hardly any noise
PLAIN_WHITE, ROLLED_OFF_WHITE = 1.0, 16.0


@dataclass(frozen=True)
class LightScene:
    """A copy of the user's scene that renders one window of its picture.

    Attributes
    ----------
    own : OwnCollections
        In which its objects are.
    mirrors : dict of bpy.types.Object to bpy.types.Object
        What shows each mirror: itself or a copy.
    before : list
        Objects that cut through the mirrors.
    fog : list
        Copies of fog that is clear before the mirrors.
    alone : bool
        Whether the camera sees no more than the mirrors.
    exact : bool
        Whether the mirrors have no roughness.
    """

    scene: bpy.types.Scene
    results: list
    own: OwnCollections
    mirrors: dict
    before: list
    fog: list
    alone: bool
    exact: bool

    def light(self, samples: int, density: int = 1) -> Renders[np.ndarray]:
        """What the mirrors show in the window, (height, width, 4) float32 in linear light from the lowest row up, with
        as many `samples` for `density` x `density` texels; where they are alone, with how much of each they cover, else
        with nothing in the fourth place."""
        self.scene.cycles.samples = max(samples // density**2, 1)
        # to filter albedo and normals first takes twice as long as all else that the denoiser does
        denoise(self.scene.cycles, "NONE" if self.exact and samples >= STEADY_SAMPLES else "ACCURATE")
        self.scene.render.film_transparent = self.alone
        # for the other render, if there is one: what is kept for none outlives the scene
        self.scene.render.use_persistent_data = True
        return (yield from rendering(self.scene))

    def coverage(self) -> Renders[tuple[np.ndarray, np.ndarray]]:
        """How much of each pixel the results cover, and those of their faces that show what shines, both (height,
        width) float32, by the picture's own filter: nothing where something stands before them. What mirrors are not
        alone in has to be asked. The scene shows nothing else afterwards."""
        scene, layer = self.scene, self.scene.view_layers[0]
        stage = bpy.data.collections.new("Reflection Light")
        opaque, shining = _glow((0.0, 1.0, 1.0)), _glow((1.0, 0.0, 0.0))
        # no more than whether something is there is asked: no texture, no lamp, no sky
        layer.material_override = None if any(map(shining_slots, self.results)) else opaque
        scene.world = None
        made: list = [opaque, shining]
        # results may lie in their mirrors or behind them
        unseen = [shown for mirror, shown in self.mirrors.items() if self.alone or mirror.reflection_mesh.camera_hidden]
        try:
            # what hides the results in the picture does so here where it is in the picture of light
            hiding = self.before if self.alone else [obj for obj in self.own.seen if obj not in unseen + self.fog]
            self.own.leave_out(obj for obj in self.own.shown if obj not in hiding)
            self.own.hold_out(hiding)
            scene.collection.children.link(stage)
            for result in self.results:
                made.append(_stand_in(result, opaque, shining))
                stage.objects.link(made[-1])
            cycles = scene.cycles
            cycles.samples, cycles.max_bounces, cycles.use_denoising = COVERAGE_SAMPLES, 0, False
            cycles.use_adaptive_sampling = True
            cycles.adaptive_min_samples, cycles.adaptive_threshold = INNER_SAMPLES, UNEVEN
            scene.render.film_transparent, scene.render.use_persistent_data = True, False
            seen = yield from rendering(scene)
            return seen[..., 3], seen[..., 0]
        finally:
            bpy.data.batch_remove([*still_there(made), stage])


@contextmanager
def light_scene(context: bpy.types.Context, results: list, window: Window) -> Iterator[LightScene]:
    """The user's scene as a copy that shares its objects, none of which changes; results are hidden in the copy, their
    mirrors seen."""
    with copied_scene(context, "Reflection Light") as (scene, back):
        _prepare(scene, window)
        put_swift_world(scene, back)
        own = OwnCollections(context, scene, back)
        look_through(scene, sharp_camera(context.scene.camera), back)
        mirrors = {mirror: _shown_mirror(mirror, own, back)
                   for mirror in {mirror for result in results for mirror in mirrors_of(result)}}
        own.leave_out(results)
        others = [obj for obj in own.shown if obj not in mirrors.values()]
        # where a mirror stands in fog, Cycles knows of it on the way from there by the way to there alone
        fog = list(filter(is_of_fog, others))
        others = [obj for obj in others if obj not in fog]
        fog = clear_air(scene, own, fog, back)
        materials = [material for mirror in mirrors for material in all_materials_of(mirror)]
        no_copies = len({result.reflection_mesh.mirror for result in results}) == len(results)
        alone = no_copies and all(map(is_opaque, materials)) and not _seen_lamps(context, {*mirrors})
        before = _cutting(context, {*mirrors}, others) if alone else []
        own.hold_out(before)
        # were what lets light through in the picture of light too, it would be seen twice; the rest only costs samples,
        # but where a mirror lets light through, that is what is seen there; mirrors show all of it as ever
        own.hide_from_camera([obj for obj in others if obj not in before] if alone
                             else _looked_through(context, results, others))
        yield LightScene(scene, results, own, mirrors, before, fog, alone, all(map(is_exact, materials)))


def _shown_mirror(mirror: bpy.types.Object, own: OwnCollections, back: ExitStack) -> bpy.types.Object:
    """Return what shows a mirror to the camera: itself, or a copy where that is unseen or a shadow catcher.

    A mirror that lamps are linked to, or that is random by its name, has no copy that looks alike: it is itself seen
    for a while.
    """
    changed = {name: seen for name, seen in SEEN.items() if getattr(mirror, name) != seen}
    if not changed:
        return mirror
    alike = not (is_linked(mirror) or goes_by_name(mirror))
    shown = own.copy_of(mirror) if alike else mirror
    for name, seen in changed.items():
        if not alike:
            back.callback(setattr, mirror, name, not seen)
        setattr(shown, name, seen)
    return shown


def _seen_lamps(context: bpy.types.Context, mirrors: set) -> bool:
    """Return True where the camera sees instanced lamps, which nothing in a scene of its own can hide from it."""
    return any(instance.is_instance and instance.object.type == "LIGHT" and instance.object.visible_camera
               and instance.parent.original not in mirrors
               for instance in context.evaluated_depsgraph_get().object_instances)


def _looked_through(context: bpy.types.Context, results: list, others: list) -> list:
    """Those of others that let light through and that the camera sees results through. Behind mirrors that let light
    through as well, such others are a part of what is seen there."""
    clear = list(itertools.filterfalse(_is_opaque, others))
    if not clear:
        return []
    before = standing_before(context.scene, context.evaluated_depsgraph_get(), read_view(context),
                             np.concatenate([on_the_mirror(result) for result in results]))
    return [obj for obj in clear if obj in before]


def _cutting(context: bpy.types.Context, mirrors: set, others: list) -> list:
    """Those of others that must hide what they hide of the mirrors, though the camera sees these alone.

    Within what cuts through it a mirror shows the inside of that, which no result has, and which cannot be told from
    what the mirror shows beside.
    """
    return cut_through(context.evaluated_depsgraph_get(), mirrors, list(filter(_is_opaque, others)))


def _is_opaque(obj: bpy.types.Object) -> bool:
    return all(map(is_opaque, materials_of(obj)))


def white_of(scene: bpy.types.Scene) -> float:
    """The linear light from which on a scene's pictures are white; where a view rolls highlights off, nearly."""
    plain = scene.view_settings.view_transform in {"Standard", "Raw"}
    return paper_white_of(scene) * (PLAIN_WHITE if plain else ROLLED_OFF_WHITE)


def paper_white_of(scene: bpy.types.Scene) -> float:
    """The linear light that white paper in full light has in a scene's pictures; what is brighter is overexposed, be
    it that the view rolls that off."""
    return 0.5 ** scene.view_settings.exposure


def _prepare(scene: bpy.types.Scene, window: Window) -> None:
    """One window of the picture, nothing after the render."""
    render, cycles = scene.render, scene.cycles
    only_the_picture(render)
    low = window.column, window.row
    crop_to(render, low, (low[0] + window.width, low[1] + window.height), window.size)
    cycles.film_exposure, cycles.film_transparent_glass = 1.0, False


def _glow(colour: tuple[float, float, float]) -> bpy.types.Material:
    """A material as bright as nothing is dark, so that adaptive sampling finds where both meet."""
    made = bpy.data.materials.new("Reflection Light Opaque")
    tree = compat.use_nodes(made)
    tree.nodes.clear()
    glow, output = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "OutputMaterial"))
    glow.inputs["Color"].default_value = (*colour, 1.0)
    tree.links.new(glow.outputs[0], output.inputs[0])
    return made


def _stand_in(result: bpy.types.Object, opaque: bpy.types.Material, shining: bpy.types.Material) -> bpy.types.Object:
    """A result as the camera sees it, and nothing else does."""
    copy, shine = result.copy(), shining_slots(result)
    copy.hide_render = False
    for number, slot in enumerate(copy.material_slots):
        slot.link, slot.material = "OBJECT", shining if number in shine else opaque
    return copy
