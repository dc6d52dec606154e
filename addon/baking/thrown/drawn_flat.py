"""Meshes of light in a plane, drawn by Cycles texel by texel."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from mathutils import Matrix

from ... import compat
from ...faults import still_there
from ...illumination import light_alone
from ...rendering import Renders, copied_scene, crop_to, look_through, rendering
from ...writing import MeshArrays, write_mesh

NAME = "Thrown Light"
SAMPLES = 16    # a texel: nothing in it is by chance but where the samples lie
LAYERS = 1024   # that may lie over each other: the most that Cycles follows


def drawn_flat(context: bpy.types.Context, laid: list[MeshArrays], low: np.ndarray, high: np.ndarray,
               side: int) -> Renders[np.ndarray]:
    """The picture, (height, width, 4) linear light and what of each texel is covered, of meshes that lie in a square,
    0 to 1, each less than one above the one before; of `side` texels along the square those from `low` to `high`,
    column and row. Materials that add light show that alone, all else is black."""
    with _stage(context, laid) as scene:
        _look_at(scene, low, high, side)
        return (yield from rendering(scene))


@contextmanager
def _stage(context: bpy.types.Context, laid: list[MeshArrays]) -> Iterator[bpy.types.Scene]:
    """A scene with nothing but these meshes."""
    made: list = []
    with copied_scene(context, NAME) as (scene, back):
        back.callback(lambda: bpy.data.batch_remove(still_there(made)))
        scene.world = scene.view_layers[0].material_override = None
        for within in (scene.collection.children, scene.collection.objects):
            for one in list(within):
                within.unlink(one)
        shown: dict = {}
        for arrays in laid:
            mesh = bpy.data.meshes.new(NAME)
            obj = bpy.data.objects.new(NAME, mesh)
            made += [mesh, obj]
            write_mesh(mesh, arrays)
            for number, material in enumerate(arrays.materials):
                if material not in shown:
                    shown[material] = light_alone(material) or _black()
                    made.append(shown[material])
                mesh.materials[number] = shown[material]
            scene.collection.objects.link(obj)
        camera = bpy.data.cameras.new(NAME)
        camera.type, camera.ortho_scale = "ORTHO", 1.0
        camera.clip_start, camera.clip_end = 0.5, len(laid) + 2.0
        eye = bpy.data.objects.new(NAME, camera)
        eye.matrix_world = Matrix.Translation((0.5, 0.5, len(laid) + 1.0))
        look_through(scene, eye, back)
        yield scene


def _black() -> bpy.types.Material:
    black = bpy.data.materials.new(NAME)
    tree = compat.use_nodes(black)
    tree.nodes.clear()
    glow, output = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "OutputMaterial"))
    glow.inputs["Strength"].default_value = 0.0
    tree.links.new(glow.outputs[0], output.inputs[0])
    return black


def _look_at(scene: bpy.types.Scene, low: np.ndarray, high: np.ndarray, side: int) -> None:
    """Let the scene be drawn between columns and rows, texel by texel, with nothing after the render."""
    render, cycles = scene.render, scene.cycles
    for name in ("use_compositing", "use_sequencer", "use_motion_blur", "use_simplify", "use_freestyle",
                 "use_multiview", "use_stamp"):
        setattr(render, name, False)
    render.resolution_x = render.resolution_y = side
    render.resolution_percentage, render.pixel_aspect_x, render.pixel_aspect_y = 100, 1.0, 1.0
    render.film_transparent = True
    crop_to(render, low.tolist(), high.tolist(), (side, side))
    cycles.film_exposure, cycles.samples, cycles.pixel_filter_type, cycles.filter_width = 1.0, SAMPLES, "BOX", 1.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces, cycles.transparent_max_bounces = 0, LAYERS
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
