"""A temporary scene in which Cycles bakes the light on objects, by stand-ins whose triangles have room of their own."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ...core import ReflectionError, View
from .. import compat
from ..faults import still_there
from ..reading.materials import glows
from ..rendering import copied_scene, denoise, look_through, put_swift_world
from ..writing import UV_MAP
from .bake_targets import new_target
from .linked_lamps import link_lamps
from .stand_ins import StandIn, new_object, swap_names
from .texels import UNTOUCHED, has_pattern, mean_of_what_is_known, moved


@dataclass(frozen=True)
class BakeScene:
    """The scene, the stand-ins of each participant, and what their materials (None where there is none) become while
    they are baked; `switches` put the light that these have of their own out where they are 1, and `clamped` is how
    bright it is at most, 0 where it may be as bright as it likes, and None where it is clamped as all light is."""

    scene: bpy.types.Scene
    objects: list
    targets: dict
    switches: list
    clamped: float | None

    def bake(self, owner: int, size: tuple[int, int], seen_from: np.ndarray, samples: int,
             denoised: bool = False) -> np.ndarray:
        """One participant's picture, (height, width, 4) float32, `UNTOUCHED` where it is not, as seen from a place; its
        `size` is width and height."""
        scene = self.scene
        scene.cycles.use_denoising = False
        if denoised:
            # what a bake tells of albedo and normals has hardly any noise
            denoise(scene.cycles, "FAST")
        scene.camera.matrix_world = Matrix.Translation(seen_from)
        apart = self.clamped is not None and self._any(owner, glows)
        for switch in self.switches:
            switch.default_value = float(apart)
        try:
            found = self._baked_all_over(owner, size, samples)
        finally:
            for switch in self.switches:
                switch.default_value = 0.0
        if apart:
            own = self._own_light(owner, size, samples)
            found[..., :3] += np.where(found[..., 3:] == UNTOUCHED, 0.0, own[..., :3])
        return found

    def colours(self, owner: int, size: tuple[int, int], samples: int) -> np.ndarray | None:
        """The colours of what is matte or shines, as `bake` has light; None where they have no pattern."""
        if not self._any(owner, has_pattern):
            return None
        found = self.matte(owner, size, samples)
        return found + self._own_light(owner, size, samples) if self._any(owner, glows) else found

    def matte(self, owner: int, size: tuple[int, int], samples: int) -> np.ndarray:
        """What part of the light that falls on a participant it sends back as what is matte does, as `bake` has
        light."""
        self.scene.cycles.use_denoising = False
        return self._baked_all_over(owner, size, samples, type="DIFFUSE", pass_filter={"COLOR"})

    def _own_light(self, owner: int, size: tuple[int, int], samples: int) -> np.ndarray:
        """What a participant shines by itself: a mirror shows that as bright as the camera would see it."""
        cycles = self.scene.cycles
        of_all, cycles.use_denoising = cycles.sample_clamp_direct, False
        if self.clamped is not None:
            cycles.sample_clamp_direct = self.clamped
        try:
            return self._baked_all_over(owner, size, samples, type="EMIT")
        finally:
            cycles.sample_clamp_direct = of_all

    def _any(self, owner: int, kind: Callable) -> bool:
        """Whether any of a participant's materials is of a kind."""
        return any(kind(slot.material) for number, obj in self.objects if number == owner
                   for slot in obj.material_slots)

    def _baked_all_over(self, owner: int, size: tuple[int, int], samples: int, **what) -> np.ndarray:
        """What bakes tell that together look at texels from side to side, where that matters."""
        scene, objects = self.scene, [obj for number, obj in self.objects if number == owner]
        places = compat.places_in_texels() if self._any(owner, has_pattern) else ((0.0, 0.0),)
        scene.cycles.samples = max(round(samples / len(places)), 1)
        seed, found = scene.cycles.seed, []
        try:
            for number, place in enumerate(places):
                scene.cycles.seed = seed + number
                with moved(objects, np.array(place) / np.maximum(size, 1)):
                    found.append(self._baked(objects, size, **what))
        finally:
            scene.cycles.seed = seed
        return mean_of_what_is_known(found)

    def _baked(self, objects: list, size: tuple[int, int], **what) -> np.ndarray:
        """One bake of `objects`, of all light where `what` names nothing else."""
        width, height = size
        values = np.full((height, width, 4), UNTOUCHED, dtype=np.float32)
        if not values.size:
            return values
        scene = self.scene
        image = bpy.data.images.new(UV_MAP, width, height, float_buffer=True, is_data=True, alpha=True)
        try:
            image.pixels.foreach_set(values.reshape(-1))
            for target in self.targets.values():
                target.node_tree.nodes.active.image = image
            self._show(objects, as_target=True)
            with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0], selected_objects=objects,
                                           active_object=objects[0], object=objects[0]):
                done = bpy.ops.object.bake(**({"type": "COMBINED"} | what), use_clear=False, margin=0,
                                           save_mode="INTERNAL", target="IMAGE_TEXTURES",
                                           use_selected_to_active=False, uv_layer=UV_MAP)
            if done != {"FINISHED"}:
                raise ReflectionError("Baking was cancelled: nothing has changed.")
            image.pixels.foreach_get(values.reshape(-1))
        finally:
            self._show(objects, as_target=False)
            bpy.data.images.remove(image)
        return values

    def _show(self, objects: list, as_target: bool) -> None:
        """Only what is baked shows a target: on all else its shadows fall as they do."""
        for slot in (slot for obj in objects for slot in obj.material_slots):
            slot.link = "DATA"
            if as_target:
                target = self.targets[slot.material]
                slot.link, slot.material = "OBJECT", target


@contextmanager
def bake_scene(context: bpy.types.Context, view: View, sources: list, stands: list[tuple[StandIn, bpy.types.Mesh]], *,
               opacity: bool, backs: bool) -> Iterator[BakeScene]:
    """The user's scene as a copy, with stand-ins, each with its mesh, in place of `sources`; with `opacity` they glow
    by how opaque they are, and with `backs` what is baked is turned over. What materials ask of the camera is answered
    as to `view`. The meshes go with the scene."""
    with copied_scene(context, UV_MAP) as (scene, back):
        made = [mesh for _, mesh in stands]
        back.callback(lambda: bpy.data.batch_remove(still_there(made)))
        _prepare(scene)
        if opacity:
            # they glow by themselves
            scene.world = None
        else:
            put_swift_world(scene, back)
        look_through(scene, bpy.data.objects.new(UV_MAP, bpy.data.cameras.new(UV_MAP)), back)
        for source in sources:
            back.callback(setattr, source, "hide_render", source.hide_render)
            source.hide_render = True
        materials = dict.fromkeys(material for stand, _ in stands for material in stand.mesh.materials or (None,))
        switches: list = []
        targets = {material: new_target(material, view, (opacity, backs), made, switches) for material in materials}
        objects = []
        for stand, mesh in stands:
            obj = new_object(sources[stand.owner], stand, mesh)
            made.append(obj)
            scene.collection.objects.link(obj)
            objects.append((stand.owner, obj))
            # linked objects keep their names
            if stand.told is None and sources[stand.owner].library is None:
                swap_names(sources[stand.owner], obj)
                back.callback(swap_names, sources[stand.owner], obj)
        link_lamps([(sources[owner], obj) for owner, obj in objects], back)
        # Cycles clamps a lamp's body one bounce later than what lamps light
        own, of_all = context.scene.cycles.sample_clamp_direct, scene.cycles.sample_clamp_direct
        yield BakeScene(scene, objects, targets, switches, None if opacity or own == of_all else own)


def _prepare(scene: bpy.types.Scene) -> None:
    bake = scene.render.bake
    for name in ("use_pass_direct", "use_pass_indirect", "use_pass_diffuse", "use_pass_glossy", "use_pass_transmission",
                 "use_pass_emit"):
        setattr(bake, name, True)
    bake.view_from = "ACTIVE_CAMERA"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = False
    # the eye sees by way of the mirror, which is one bounce, and whose light counts as indirect
    cycles.max_bounces, cycles.glossy_bounces = max(cycles.max_bounces - 1, 0), max(cycles.glossy_bounces - 1, 0)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect
    # the picture that shows the light is exposed
    cycles.film_exposure = 1.0
