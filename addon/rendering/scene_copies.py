"""Copies of the user's scene, for Cycles to work on while the file stays as it is."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import product

import bpy

from ..reading import mirrors_of
from .cycles_pictures import with_cycles

MOST_SEED = 2**31  # before which Blender's numbers end
SEEN = {"visible_camera": True, "is_shadow_catcher": False}  # what a camera sees as it is


@contextmanager
def copied_scene(context: bpy.types.Context, name: str) -> Iterator[tuple[bpy.types.Scene, ExitStack]]:
    """A copy that shares the scene's objects, with the present view layer alone and a noise of its own: what comes of
    it must not agree with a render of the file by having the same. What else is changed for a while the caller tells
    the stack, which takes it back before the copy goes."""
    scene = context.scene.copy()
    with ExitStack() as back:
        back.callback(bpy.data.scenes.remove, scene)
        # an engine that is kept for a scene that goes, be it by the user's setting or by one that an error has left,
        # would be found by the name of the next such scene, and still hold this one; switched off Blender frees it
        back.callback(_keep_no_engine, scene)
        _keep_no_engine(scene)
        scene.name = name
        with_cycles(scene)
        for other in [other for other in scene.view_layers if other.name != context.view_layer.name]:
            scene.view_layers.remove(other)
        _forget_layer_settings(scene.view_layers[0])
        # else what it animates is set again as it is rendered
        scene.animation_data_clear()
        scene.cycles.seed = (scene.cycles.seed + 1) % MOST_SEED
        yield scene, back


def _forget_layer_settings(layer: bpy.types.ViewLayer) -> None:
    """Reset the settings of a view layer that override the scene's render settings and the objects' materials."""
    layer.use, layer.samples, layer.material_override = True, 0, None
    layer.cycles.use_denoising = True


def _keep_no_engine(scene: bpy.types.Scene) -> None:
    scene.render.use_persistent_data = False


def look_through(scene: bpy.types.Scene, camera: bpy.types.Object, back: ExitStack) -> None:
    """Let a temporary camera be that of a temporary scene."""
    back.callback(bpy.data.cameras.remove, camera.data)
    scene.collection.objects.link(camera)
    scene.camera = camera


def sharp_camera(camera: bpy.types.Object) -> bpy.types.Object:
    """A copy of a camera with all in focus."""
    copy, copy.data = camera.copy(), camera.data.copy()
    copy.data.dof.use_dof = False
    return copy


def only_the_picture(render: bpy.types.RenderSettings) -> None:
    """Let a temporary scene render at one moment, from one eye, over its world, and do nothing after that."""
    for name in ("use_compositing", "use_sequencer", "use_motion_blur", "use_freestyle", "use_multiview", "use_stamp",
                 "film_transparent"):
        setattr(render, name, False)


def show_mirrors(results: list, back: ExitStack) -> None:
    """Let mirrors be seen in the place of results, be it that the camera else sees none, or nothing but shadows on
    them, until the stack takes that back."""
    for result in results:
        back.callback(setattr, result, "hide_render", result.hide_render)
        result.hide_render = True
        for mirror, (name, seen) in product(mirrors_of(result), SEEN.items()):
            if getattr(mirror, name) != seen:
                back.callback(setattr, mirror, name, not seen)
                setattr(mirror, name, seen)
