"""The picture with the mirror, and the picture with the mesh in its place."""
from __future__ import annotations

import time
from collections.abc import Generator
from contextlib import ExitStack
from dataclasses import dataclass

import bpy
import numpy as np

from ..judge import CopiedScene, render_picture, show, take_settings
from ..reading import is_result
from ..rendering import Renders, copied_scene, look_through, only_the_picture, sharp_camera, show_mirrors

NAME = "Reflection Comparison"


@dataclass(frozen=True)
class Pictures:
    """Cycles' renders of a scene.

    Attributes
    ----------
    reference, result : (height, width, 3) float32
        With the mirror, and with the mesh in front of it; linear light, rows from bottom to top.
    seconds : dict
        Render times of the two, by their names.
    again : (height, width, 3) float32 or None
        `reference` with another random seed, the smallest difference that is possible; if the mesh shows light.
    """

    reference: np.ndarray
    result: np.ndarray
    seconds: dict
    again: np.ndarray | None = None


def render_pictures(copied: CopiedScene, user: bpy.types.Scene, samples: int) -> Generator[str | None, None, Pictures]:
    """Render both pictures of a copied scene, in which a mirror with a mesh before it reflects the world alone; yields
    the name of each before it, and nothing while Blender renders beside."""
    scene = copied.scene
    copied.light_up(user.world)
    visible = [(copy, copy.visible_camera, copy.visible_glossy) for copy in copied.everything]
    for copy, _ in copied.mirrors:
        copy.visible_camera = True
    show(copied.results, False)
    yield "the picture with the mirror"
    reference, first = yield from _timed(scene, samples, user)
    for copy, camera, glossy in visible:
        copy.visible_camera, copy.visible_glossy = camera, glossy
    for copy, _ in copied.diffuse:
        copy.visible_glossy = False
    show(copied.results, True)
    yield "the picture with the mesh"
    result, second = yield from _timed(scene, samples, user)
    return Pictures(reference, result, {"reference": first, "result": second})


def render_lit(context: bpy.types.Context, results: list, samples: int) -> Generator[str | None, None, Pictures]:
    """Render the file with its mirrors, once more with other noise, and as it is, with the meshes `results` that show
    light; yields as `render_pictures`, and leaves the file as it was wherever it is closed.

    No copy of an object is lit as that object is: *Object Info > Random* goes by its name, Generated coordinates by its
    shape before modifiers, and what links it with lamps, its hair and its fog are its own.
    """
    user = context.scene
    with copied_scene(context, NAME) as (scene, back):
        only_the_picture(scene.render)
        scene.render.use_border = scene.render.use_persistent_data = False
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
        scene.cycles.time_limit = 0.0
        take_settings(scene, user)
        look_through(scene, sharp_camera(user.camera), back)
        show_mirrors([obj for obj in user.objects if is_result(obj) and obj not in results],
                     back)
        with ExitStack() as without:
            show_mirrors(results, without)
            yield "the picture with the mirror"
            reference, first = yield from _timed(scene, samples, user)
            yield "the picture with the mirror once more"
            again = yield from render_picture(scene, samples, user, other_noise=True)
        yield "the picture with the mesh"
        result, second = yield from _timed(scene, samples, user)
    return Pictures(reference, result, {"reference": first, "result": second}, again)


def _timed(scene: bpy.types.Scene, samples: int, user: bpy.types.Scene) -> Renders[tuple[np.ndarray, float]]:
    """Return a picture and its render time in seconds."""
    started = time.perf_counter()
    picture = yield from render_picture(scene, samples, user)
    return picture, time.perf_counter() - started
