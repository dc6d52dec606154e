"""Bakes of the light on objects, in a temporary scene of theirs: in one, or in bands between which a window goes on."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter

import bpy
import numpy as np
from mathutils import Matrix

from ....core import ReflectionError
from ... import compat
from ...faults import Steps, Undivided, between_events, part
from ...reading.materials import glows
from ...rendering import MOST_SEED, denoise
from ...writing import UV_MAP
from ..texels import UNTOUCHED, framed, has_pattern, mean_of_what_is_known
from .bands import Bands, samples_in_rows
from .guided_scene import PASSES, guided_scene
from .tiles import Tile, in_tiles

OWN = 0.9    # of the work of a picture, before its own light
NOISY = 0.9  # of the work in bands, before it is denoised
SEEDS = 7919  # from a row to the next


@dataclass(frozen=True)
class BakeScene:
    """The scene, the stand-ins of each participant, and what their materials (None where there is none) become while
    they are baked; `switches` put the light that these have of their own out where they are 1, and `clamped` is how
    bright it is at most, 0 where it may be as bright as it likes, and None where it is clamped as all light is; `bands`
    tell how much is baked at a time, by object and by what is baked of it."""

    scene: bpy.types.Scene
    objects: list
    targets: dict
    switches: list
    clamped: float | None
    bands: dict = field(default_factory=dict)

    def bake(self, owner: int, size: tuple[int, int], seen_from: np.ndarray, samples: int,
             denoised: bool = False) -> Steps[np.ndarray]:
        """One participant's picture, (height, width, 4) float32, `UNTOUCHED` where it is not, as seen from a place; its
        `size` is width and height."""
        self.scene.camera.matrix_world = Matrix.Translation(seen_from)
        apart = self.clamped is not None and self._any(owner, glows)
        for switch in self.switches:
            switch.default_value = float(apart)
        try:
            found = yield from part(self._baked_all_over(owner, size, samples, denoised), 0.0, OWN if apart else 1.0)
        finally:
            for switch in self.switches:
                switch.default_value = 0.0
        if apart:
            own = yield from part(self._own_light(owner, size, samples), OWN, 1.0 - OWN)
            found[..., :3] += np.where(found[..., 3:] == UNTOUCHED, 0.0, own[..., :3])
        return found

    def colours(self, owner: int, size: tuple[int, int], samples: int) -> Steps[np.ndarray | None]:
        """The colours of what is matte or shines, as `bake` has light; None where they have no pattern."""
        if not self._any(owner, has_pattern):
            return None
        found = yield from self.matte(owner, size, samples)
        return found + (yield from self._own_light(owner, size, samples)) if self._any(owner, glows) else found

    def matte(self, owner: int, size: tuple[int, int], samples: int) -> Steps[np.ndarray]:
        """What part of the light that falls on a participant it sends back as what is matte does, as `bake` has
        light."""
        return (yield from self._baked_all_over(owner, size, samples, type="DIFFUSE", pass_filter={"COLOR"}))

    def _own_light(self, owner: int, size: tuple[int, int], samples: int) -> Steps[np.ndarray]:
        """What a participant shines by itself: a mirror shows that as bright as the camera would see it."""
        with self._clamped_at(self.clamped):
            return (yield from self._baked_all_over(owner, size, samples, type="EMIT"))

    @contextmanager
    def _clamped_at(self, bright: float | None) -> Iterator[None]:
        """What is met first is at most so bright; as all else where it is None."""
        cycles = self.scene.cycles
        of_all = cycles.sample_clamp_direct
        cycles.sample_clamp_direct = of_all if bright is None else bright
        try:
            yield
        finally:
            cycles.sample_clamp_direct = of_all

    def _any(self, owner: int, kind: Callable) -> bool:
        """Whether any of a participant's materials is of a kind."""
        return any(kind(slot.material) for number, obj in self.objects if number == owner
                   for slot in obj.material_slots)

    def _baked_all_over(self, owner: int, size: tuple[int, int], samples: int, denoised: bool = False,
                        **what) -> Steps[np.ndarray]:
        """What bakes tell that together look at texels from side to side, where that matters."""
        scene, objects = self.scene, [obj for number, obj in self.objects if number == owner]
        places = compat.places_in_texels() if self._any(owner, has_pattern) else ((0.0, 0.0),)
        scene.cycles.samples = max(round(samples / len(places)), 1)
        seed, found = scene.cycles.seed, []
        try:
            for number, place in enumerate(places):
                scene.cycles.seed = (seed + number) % MOST_SEED
                # what a texel shows more to the right lies there when all is moved to the left
                with framed(objects, np.array(place) / np.maximum(size, 1), np.ones(2)):
                    found.append((yield from part(self._baked(objects, size, denoised, **what), number / len(places),
                                                  1.0 / len(places))))
        finally:
            scene.cycles.seed = seed
        yield 1.0, ""
        return mean_of_what_is_known(found)

    def _baked(self, objects: list, size: tuple[int, int], denoised: bool, **what) -> Steps[np.ndarray]:
        """One bake of `objects`, of all light where `what` names nothing else: in bands where a window waits for it,
        which are then denoised together."""
        width, height = size
        values = np.full((height, width, 4), UNTOUCHED, dtype=np.float32)
        if not values.size:
            return values
        with self._targets(objects, size) as image:
            if between_events():
                yield from part(self._in_bands(image, values, objects, **what), 0.0, NOISY if denoised else 1.0)
                if denoised:
                    yield from part(self._denoise(image, values, objects), NOISY, 1.0 - NOISY)
                return values
            yield 0.0, Undivided("")
            if denoised:
                # what a bake tells of albedo and normals has hardly any noise
                denoise(self.scene.cycles, "FAST")
            try:
                self._bake_into(image, values, objects, self.scene, **what)
            finally:
                self.scene.cycles.use_denoising = False
        return values

    def _bands(self, name: str, kind: str | None) -> Bands:
        """What tells how much of an object is baked at a time, where that kind of light is."""
        if (name, kind) not in self.bands:
            self.bands[name, kind] = Bands(min((others.samples for others in self.bands.values()), default=0.0))
        return self.bands[name, kind]

    def _in_bands(self, image: bpy.types.Image, values: np.ndarray, objects: list, **what) -> Steps[None]:
        """The same in bands of the picture, (height, width, 4), without denoising."""
        height, width = values.shape[:2]
        cycles, bands, row = self.scene.cycles, self._bands(objects[0].name, what.get("type")), 0
        samples = samples_in_rows(objects, (width, height), cycles.samples)
        seed, ended = cycles.seed, perf_counter()
        try:
            while row < height:
                yield samples[:row].sum() / samples.sum(), Undivided("") if bands.are_long else ""
                end = row + bands.rows(samples, row)
                # the same seed would give each band the same noise
                cycles.seed = (seed + SEEDS * row) % MOST_SEED
                began = perf_counter()
                with framed(objects, np.array((0.0, row / height)), np.array((1.0, (end - row) / height))):
                    self._bake_into(image, values[row:end], objects, self.scene, **what)
                between, ended = began - ended, perf_counter()
                # a short one, as the last, tells little of the others
                if end < height:
                    bands.took(ended - began, samples[row:end].sum(), between)
                row = end
        finally:
            cycles.seed = seed

    def _denoise(self, image: bpy.types.Image, values: np.ndarray, objects: list) -> Steps[None]:
        """Denoise light that was baked, as Cycles does where it bakes it in one, in tiles."""
        height, width = values.shape[:2]

        def denoised(tile: Tile) -> np.ndarray:
            noisy, low = values[tile], np.array((tile[1].start / width, tile[0].start / height))
            found = np.empty_like(noisy)
            with new_image(noisy) as shone, guided_scene(self.scene, objects, self.switches, shone) as scene, framed(
                    objects, low, np.array(noisy.shape[1::-1]) / (width, height)):
                self._bake_into(image, found, objects, scene, pass_filter=PASSES)
            return found
        for share in in_tiles(values, denoised):
            yield share, ""

    @contextmanager
    def _targets(self, objects: list, size: tuple[int, int]) -> Iterator[bpy.types.Image]:
        """What `objects` are baked into, once for all bands of it: after each change of materials and images Blender
        looks through the user's whole scene."""
        width, height = size
        with new_image(np.full((height, width, 4), UNTOUCHED, dtype=np.float32)) as image:
            for target in self.targets.values():
                target.node_tree.nodes.active.image = image
            self._show(objects, as_target=True)
            try:
                yield image
            finally:
                self._show(objects, as_target=False)

    def _bake_into(self, image: bpy.types.Image, values: np.ndarray, objects: list, scene: bpy.types.Scene,
                   **what) -> None:
        """One bake in one step, into a picture (height, width, 4)."""
        height, width = values.shape[:2]
        if tuple(image.size) != (width, height):
            image.scale(width, height)
        image.pixels.foreach_set(np.full(values.size, UNTOUCHED, dtype=np.float32))
        with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0], selected_objects=objects,
                                       active_object=objects[0], object=objects[0]):
            done = bpy.ops.object.bake(**({"type": "COMBINED"} | what), use_clear=False, margin=0,
                                       save_mode="INTERNAL", target="IMAGE_TEXTURES",
                                       use_selected_to_active=False, uv_layer=UV_MAP)
        if done != {"FINISHED"}:
            raise ReflectionError("Baking was cancelled: nothing has changed.")
        image.pixels.foreach_get(values.reshape(-1))

    def _show(self, objects: list, as_target: bool) -> None:
        """Only what is baked shows a target: on all else its shadows fall as they do."""
        for slot in (slot for obj in objects for slot in obj.material_slots):
            slot.link = "DATA"
            if as_target:
                target = self.targets[slot.material]
                slot.link, slot.material = "OBJECT", target


@contextmanager
def new_image(values: np.ndarray) -> Iterator[bpy.types.Image]:
    """An image of numbers, (height, width, 4) float32, for a while."""
    height, width = values.shape[:2]
    image = bpy.data.images.new(UV_MAP, width, height, float_buffer=True, is_data=True, alpha=True)
    try:
        image.pixels.foreach_set(values.reshape(-1))
        yield image
    finally:
        bpy.data.images.remove(image)
