"""Light as it is made for reflections: of the picture by a render, on the objects by a bake."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..baking import KeptMap, baked, can_be_baked, kept_map
from ..faults import AllOrNothing, Steps, part
from ..lamps import lamps_before, lamps_that_show
from ..lighting import (
    Window,
    beside_lamps,
    is_overexposed,
    is_plain,
    light_scene,
    make_denser,
    needed_density,
    new_export_image,
    new_image,
    new_material,
    on_the_mirror,
    paper_white_of,
    pixel_kernel,
    show_light,
    show_object_light,
    texels_of,
    white_of,
)
from ..mirror_part import LaterMirrors, Surroundings, new_object_material
from ..reading import is_opaque, mirrors_of, read_scene, seen_in
from ..reading.materials import reflecting_materials
from ..rendering import shown_while

NAME = "Reflection Light"
RENDERING = "Rendering light"


def light_in_picture(context: bpy.types.Context, lit: list, view: View, samples: int, whole: AllOrNothing,
                     lamps_apart: bool) -> Steps[Callable[[], Steps[None]]]:
    """Render what `lit` show of the picture; returns what lets them show it."""
    window = Window.around(view, np.concatenate([on_the_mirror(result) for result in lit]))
    if window is None:
        raise ReflectionError("The camera sees none of the reflections: generate them again for this view.")
    white = white_of(context.scene)
    with light_scene(context, lit, window) as scene:
        density = yield from shown_while(needed_density(scene, window, samples, white), 0.02, RENDERING)
        make_denser(scene, window, density)
        light = yield from shown_while(scene.light(samples, density), 0.04, RENDERING)
        coverage, shining = yield from shown_while(scene.coverage(), 0.9, "Rendering the area of the reflections")
    # what was clear for a while counts as changed only now
    context.view_layer.update()
    cycles = context.scene.cycles
    kernel = pixel_kernel(cycles.pixel_filter_type, cycles.filter_width)
    light, opacity = light[..., :3], light[..., 3] if scene.alone else None
    paper_white = paper_white_of(context.scene)
    # a part of a pixel is brighter where that is to be white
    white *= density**2
    texels = yield from part(texels_of(light, coverage, kernel, white, opacity), 0.93, 0.04)
    image, apart = (yield from part(new_image(NAME, texels, whole), 0.97, 0.01)), None
    if lamps_apart and is_overexposed(light, shining, paper_white):
        # what shines ends where its faces do, however bright it is: between texels it could not
        apart = []
        for name, part_of in (("Matte", beside_lamps(coverage, shining, light, paper_white)), ("Shining", shining)):
            found = yield from part(texels_of(light, part_of, kernel, white, opacity, name.upper()), 0.98,
                                    0.005)
            apart.append((yield from part(new_image(f"{NAME} {name}", found, whole), 0.985, 0.0)))
    export_image = yield from part(new_export_image(f"{NAME} Export", texels, whole), 0.99, 0.01)

    def show() -> Steps[None]:
        material = new_material(NAME, image, export_image, texels, whole, apart)
        for result in lit:
            yield from show_light(result, material, view, window, whole)
    return show


def light_on_objects(context: bpy.types.Context, lit: list, view: View, samples: int, whole: AllOrNothing
                     ) -> Steps[Callable[[], Steps[None]]]:
    """Bake the objects that `lit` show; returns what lets them show it."""
    if not can_be_baked(lit):
        raise ReflectionError("A reflection of points, or of objects that have been deleted, or one that knows only "
                              "what is seen, has no light on objects: choose Light: Picture.")
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
        light_map = kept_map(NAME, light.uv, light.frames)
        whole.undo(bpy.data.meshes.remove, light_map)
        for result in lit:
            around = Surroundings(tuple(mirrors_of(result)), lamps_before(result, lamps),
                                  LaterMirrors.of(result), not result.reflection_mesh.window)
            material = new_object_material(NAME, image, _mirror_materials(result), opaque, around, whole)
            yield from show_object_light(result, material, view, scene, KeptMap(light_map, light.sheets, light.dull),
                                         whole)
    return show


def _mirror_materials(result: bpy.types.Object) -> list[bpy.types.Material | None]:
    """The materials of a result's mirror that reflect; None where all of the light is shown."""
    reflecting = reflecting_materials(mirrors_of(result))
    return [None if is_plain(one) else one for one in reflecting] if not all(map(is_plain, reflecting)) else [None]
