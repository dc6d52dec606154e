"""The place where a command works: the scene, view layer, camera and frame in its options."""
from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import bpy

from ...core import ReflectionError
from ..reading import candidates
from .options import text


def add_place(parser: argparse.ArgumentParser, frame: bool = True) -> None:
    """Add the options for the place.

    Parameters
    ----------
    frame : bool
        True if the command works on one frame, and so with one camera.
    """
    # templates of farms name the scene even where none is given
    parser.add_argument("--scene", type=text if frame else str, metavar="NAME", help="the scene (else the file's own)")
    if frame:
        parser.add_argument("--view-layer", type=text, metavar="NAME",
                            help="whose objects are seen (else the file's own)")
        parser.add_argument("--camera", type=text, metavar="NAME", help="the camera (else the scene's, by its markers)")
        parser.add_argument("--frame", type=int, metavar="N", help="the frame (else the file's own)")


@contextmanager
def placed(context: bpy.types.Context, options: argparse.Namespace) -> Iterator[None]:
    """Set the context in the block to the place in the options. A frame and a camera stay set afterwards.

    Raises
    ------
    ReflectionError
        If there is no such scene, view layer or camera.
    """
    scene = named(bpy.data.scenes, options.scene, "scene", "the file") if options.scene else context.scene
    layer = _layer(context, scene, options.view_layer if isinstance(options.view_layer, str) else None)
    with ExitStack() as stack:
        if (scene, layer) != (context.scene, context.view_layer):
            stack.enter_context(context.temp_override(scene=scene, view_layer=layer))
        if getattr(options, "frame", None) is not None:
            scene.frame_set(options.frame)
        if isinstance(getattr(options, "camera", None), str):
            scene.camera = camera_of(scene, options.camera)
        forget_chance(context)
        yield


def forget_chance(context: bpy.types.Context) -> None:
    """Deselect everything if the selection contains no mirror. It may be left from the last click before saving.
    Without it, materials determine the mirrors.
    """
    if not candidates(context)[0]:
        for obj in context.selected_objects:
            obj.select_set(False)


def camera_of(scene: bpy.types.Scene, name: str) -> bpy.types.Object:
    """Return a scene's camera by its name."""
    found = named(scene.objects, name, "camera", f"the scene '{scene.name}'")
    if found.type != "CAMERA":
        raise ReflectionError(f"'{name}' is no camera: name one with --camera.")
    return found


def layer_of(scene: bpy.types.Scene, name: str) -> bpy.types.ViewLayer:
    """Return a scene's view layer by its name."""
    return named(scene.view_layers, name, "view layer", f"the scene '{scene.name}'")


def named(items, name: str, what: str, where: str):
    """Return one of Blender's data-blocks or view layers by its name.

    Parameters
    ----------
    items : bpy.types.bpy_prop_collection
    name : str
    what, where : str
        Kind of item, such as "scene", and the place that was searched, such as "the file", for the error message.

    Raises
    ------
    ReflectionError
        If there is no item of that name.
    """
    if name not in items:
        raise ReflectionError(f"There is no {what} '{name}' in {where}: check its name.")
    return items[name]


def _layer(context: bpy.types.Context, scene: bpy.types.Scene, name: str | None) -> bpy.types.ViewLayer:
    if name is not None:
        return layer_of(scene, name)
    return context.view_layer if scene == context.scene else scene.view_layers[0]
