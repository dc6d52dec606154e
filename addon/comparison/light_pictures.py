"""Cycles' own caustics at several numbers of samples, converged, and the meshes of light in the same view."""
from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..faults import Steps
from ..illumination import is_met, leaves_out, let_lamps_light_mirrors
from ..rendering import MOST_SEED, copied_scene, only_the_picture, rendering, shown_while

CHUNK = 64  # samples of one render of the reference: so often ESC is heard
NAME = "Reflection Comparison"


@dataclass(frozen=True)
class Shot:
    """A picture (height, width, 3), in linear light from the lowest row up, its samples per pixel and its seconds;
    `again` is the same with other noise."""

    samples: int
    picture: np.ndarray = field(repr=False)
    seconds: float
    again: np.ndarray | None = field(repr=False, default=None)


@dataclass(frozen=True)
class LightPictures:
    """Cycles' renders of caustics.

    Attributes
    ----------
    reference : (height, width, 3) float64
        Cycles' own caustics, converged with `samples` samples.
    variance : (height, width) float64
        Variance of the reference's mean over the colours.
    samples : int
    seconds : float
        Render time of the reference.
    own, mesh : list of Shot
        Cycles' own caustics, and the meshes, with few to many samples.
    """

    reference: np.ndarray
    variance: np.ndarray
    samples: int
    seconds: float
    own: list
    mesh: list


def render_light(context: bpy.types.Context, results: list, counts: tuple, converged: int) -> Steps[LightPictures]:
    """Render the scene with Cycles' own caustics, and with the meshes of light `results`, at `counts` samples per pixel
    and, of its own, at `converged` ones. Closed at any step it leaves the file as it was.

    All but clamping, denoising, adaptive sampling and the filter of gloss, which Cycles' own caustics do not stand,
    is as the scene has it.
    """
    chunks = _chunks(max(converged, 2 * counts[-1]))
    with copied_scene(context, NAME) as (scene, back):
        _prepare(scene)
        own_too = all(leaves_out(lamp, mirror) or not is_met(lamp) for lamp, mirror in map(_pair, results))
        seed, with_own = scene.cycles.seed, context.scene.cycles.caustics_reflective
        shots = _Shots(scene, seed, len(chunks) + 3 * len(counts))
        with ExitStack() as without:
            for obj in [obj for obj in context.scene.objects if obj.reflection_mesh.role == "CAUSTICS"]:
                without.callback(setattr, obj, "hide_render", obj.hide_render)
                obj.hide_render = True
            let_lamps_light_mirrors([_pair(result)[0] for result in results], without)
            scene.cycles.caustics_reflective = True
            total, squared, spent = 0.0, 0.0, 0.0
            for number, samples in enumerate(chunks):
                shot = yield from shots.taken(samples, 10 + number, "the reference")
                total, spent = total + samples * shot.picture.astype(np.float64), spent + shot.seconds
                squared = squared + samples * shot.picture.mean(axis=2, dtype=np.float64)**2
            own = []
            for samples in counts:
                first = yield from shots.taken(samples, 1, f"Cycles caustics at {samples} samples")
                other = yield from shots.taken(samples, 2, f"Cycles caustics at {samples} samples once more")
                own.append(Shot(samples, first.picture, 0.5 * (first.seconds + other.seconds), other.picture))
        # avoid both at once if the file has both: the light would be counted twice
        scene.cycles.caustics_reflective = with_own and own_too
        mesh = []
        for samples in counts:
            mesh.append((yield from shots.taken(samples, 1, f"the meshes of light at {samples} samples")))
    many = sum(chunks)
    reference = total / many
    spread = np.maximum(squared / many - reference.mean(axis=2)**2, 0.0)
    return LightPictures(reference, spread / max(len(chunks) - 1, 1), many, spent, own, mesh)


class _Shots:
    """A series of renders of one scene, `count` in all."""

    def __init__(self, scene: bpy.types.Scene, seed: int, count: int) -> None:
        self.scene, self.seed, self.count, self.number = scene, seed, count, 0

    def taken(self, samples: int, seed: int, what: str) -> Steps[Shot]:
        done, stage = self.number / self.count, f"Rendering {what}, {self.number + 1} of {self.count}"
        self.number += 1
        self.scene.cycles.samples, self.scene.cycles.seed = samples, (self.seed + seed) % MOST_SEED
        started = time.perf_counter()
        picture = (yield from shown_while(rendering(self.scene), done, stage))[..., :3]
        return Shot(samples, picture, time.perf_counter() - started)


def _pair(result: bpy.types.Object) -> tuple[bpy.types.Object, bpy.types.Object]:
    return result.reflection_mesh.lamp, result.reflection_mesh.mirror


def _chunks(samples: int) -> list[int]:
    """Return the samples of each render of the reference. There are at least eight renders, which show its noise."""
    number = max(8, -(-samples // CHUNK))
    return [max(samples // number + (index < samples % number), 1) for index in range(number)]


def _prepare(scene: bpy.types.Scene) -> None:
    """Set the scene up for path tracing only, of the whole picture."""
    render, cycles = scene.render, scene.cycles
    only_the_picture(render)
    render.use_border = render.use_persistent_data = False
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.time_limit = 0.0
