"""The operator that lights reflections: their results look as the mirrors do."""
from __future__ import annotations

import time

import bpy
import numpy as np

from ..core import ReflectionError
from .blender_data import read_view
from .clear import chosen_results
from .faults import AllOrNothing, SteppedOperator, Steps, Undivided
from .lighting import (
    Window,
    light_scene,
    mirror_positions,
    needs_light,
    new_export_image,
    new_image,
    new_material,
    pixel_kernel,
    show_light,
    texels_of,
    white_of,
)

SAMPLES = 64
NAME = "Reflection Light"


def lighting(context: bpy.types.Context, results: list, samples: int = SAMPLES, every: bool = False) -> Steps[list]:
    """Let `results` show the light that their mirrors show: Cycles renders the mirrors as they are, once, and each
    result shows that picture where the camera sees it.

    Yields (fraction, stage), before each render an `Undivided` one; closed at any step it leaves no trace.

    Parameters
    ----------
    samples : int
        Per pixel.
    every : bool
        Also those that look right as they are.

    Returns
    -------
    lit : list of bpy.types.Object
        Those of the results that did not look right as they were, or every one.

    Raises
    ------
    ReflectionError
        Where there is nothing to light, or a render is cancelled; nothing has changed then.
    """
    if context.mode != "OBJECT":
        raise ReflectionError("Reflections are lit in Object Mode: leave the present mode first.")
    if not results:
        raise ReflectionError("The scene has no reflection to light: generate one first.")
    yield 0.0, "Reading the scene"
    view = read_view(context)
    lit = [result for result in results if every or needs_light(result)]
    if not lit:
        return lit
    window = Window.around(view, np.concatenate([mirror_positions(result) for result in lit]))
    if window is None:
        raise ReflectionError("The camera sees none of the reflections: generate them again for this view.")
    with light_scene(context, lit, window) as scene:
        yield 0.02, Undivided("Cycles renders the light, 1 of 2")
        light = scene.light(samples)
        yield 0.9, Undivided("Cycles renders what reflections cover, 2 of 2")
        coverage = scene.coverage()
    yield 0.95, "Writing"
    cycles = context.scene.cycles
    kernel = pixel_kernel(cycles.pixel_filter_type, cycles.filter_width)
    texels = texels_of(light, coverage, kernel, white_of(context.scene))
    with AllOrNothing() as whole:
        image = new_image(NAME, texels)
        whole.undo(bpy.data.images.remove, image)
        export_image = new_export_image(f"{NAME} Export", texels)
        whole.undo(bpy.data.images.remove, export_image)
        material = new_material(NAME, image, export_image, texels)
        whole.undo(bpy.data.materials.remove, material)
        for result in lit:
            show_light(result, view, window, material, whole)
    return lit


def summary(lit: list, seconds: float) -> str:
    """One line on what was lit."""
    if not lit:
        return "Nothing to light: the reflected materials emit what they show, and the mirrors add nothing."
    return f"{', '.join(repr(obj.name) for obj in lit)}: lit in {seconds:.2f} s"


class REFLECTION_MESH_OT_light(SteppedOperator, bpy.types.Operator):
    """Let the reflections look as the mirrors do, with the scene's lamps, materials and the mirrors' own tint"""

    bl_idname = "reflection_mesh.light"
    bl_label = "Light Reflection"
    bl_options = {"REGISTER", "UNDO"}

    samples: bpy.props.IntProperty(name="Samples", default=SAMPLES, min=1, soft_max=4096,
                                   description="Light paths for each pixel of the mirrors; the picture is denoised")
    every: bpy.props.BoolProperty(name="Every", default=False, options=set(),
                                  description="Also reflections that look right as they are: for files that carry "
                                  "pictures but not all materials, as glTF and USD")

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        lit = yield from lighting(context, chosen_results(context), self.samples, self.every)
        self.report({"INFO"}, summary(lit, time.perf_counter() - started))


def draw_menu(self, context: bpy.types.Context) -> None:
    self.layout.operator(REFLECTION_MESH_OT_light.bl_idname, icon="LIGHT")


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_light)
    bpy.types.VIEW3D_MT_object.append(draw_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(draw_menu)
    bpy.utils.unregister_class(REFLECTION_MESH_OT_light)
