"""The light of reflections: Cycles shades what they show, and they show that."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..faults import AllOrNothing, Steps, part, still_there
from ..freshness import light_difference, lit_with, why_light_differs
from ..lamps import lamps_before, lamps_that_show
from ..lighting import (
    FROM_MIRROR,
    FurtherMirrors,
    KeptLight,
    Placed,
    can_be_lit,
    forget_light,
    is_plain,
    lay_out,
    light_record,
    new_export_image,
    new_image,
    new_material,
    path_scene,
    prepared,
    remember,
    render_paths,
    show_light,
    unwrap,
    write_colours,
)
from ..mirror_part import LaterMirrors, Surroundings
from ..reading import has_fog, known_results, mirrors_of
from ..reading.materials import reflecting_materials, surface_shaders
from ..rendering import shown_while
from ..writing import images_of

NAME = "Reflection Light"
RENDERING = "Rendering light"
DENSE, FEWEST = 2, 16   # texels along a pixel's side, and the samples for each pixel from which on
RIM = 4                 # texels around faces that go on as the faces do
MATTE = 8               # samples of light for each of what lamps add to the mirror itself, which is dark beside it
NOT_LIT = {"EMISSION", "BSDF_TRANSPARENT", "HOLDOUT"}  # shaders that lamps change nothing of


def light_results(context: bpy.types.Context, lit: list, view: View, samples: int, whole: AllOrNothing,
                  flat: bool = False) -> Steps[Callable[[], None]]:
    """Render what `lit` show; return what lets them show it, by one picture alone if `flat`.

    Raises
    ------
    ReflectionError
        Where a mesh does not know what it shows, or the camera sees none of it.
    """
    _check(lit)
    dense = DENSE if samples >= FEWEST else 1
    placed: dict[bpy.types.Mesh, Placed] = {}
    for result in lit:
        if result.data not in placed:
            placed[result.data] = yield from part(prepared(result, view, dense, whole), 0.0, 0.0)
    yield 0.04, "Reading the reflection"
    unwrapped = unwrap(list(placed.values()), view, dense)
    shown = known_results(context.scene, context.view_layer)
    paths = unwrapped.paths(FurtherMirrors.of([one for one in shown if one.reflection_mesh.role == "REFLECTION"], lit))
    if not paths.used.any():
        raise ReflectionError("The camera sees none of the reflections: generate them again for this view.")
    fog = has_fog(context.scene)
    if fog:
        # it counts from the mirror on
        paths = replace(paths, lead=np.full_like(paths.lead, FROM_MIRROR))
    yield 0.08, "Reading the reflection"
    kept = KeptLight.found([] if fog else _earlier_images(context, lit, view, samples), paths)
    with path_scene(context) as scene:
        steps = render_paths(scene, kept.missing(paths).grown(RIM), samples // dense**2, True)
        light = kept.completed((yield from shown_while(steps, 0.1, RENDERING)), paths, RIM)
    image = yield from part(new_image(NAME, light, whole), 0.7, 0.05)
    export_image = bpy.data.images.new(f"{NAME} Export", 1, 1)
    whole.undo(bpy.data.batch_remove, [export_image])
    materials: dict = {}
    # paths from the mirror on meet lamps themselves
    lamps = [] if fog else lamps_that_show(context)
    spots = dict(zip(placed, unwrapped.spots))
    for result in lit:
        mesh = placed[result.data].mesh
        around = Surroundings(tuple(mirrors_of(result)), lamps_before(mesh, lamps, mirrors_of(result)),
                              LaterMirrors.of(result), not result.reflection_mesh.window)
        key = result.reflection_mesh.mirror, result.data
        if key not in materials:
            materials[key] = new_material(NAME, image, export_image, _mirror_materials(result), around, whole)
            lay_out(mesh, result, view, spots[result.data], materials[key])
    matte, paths_seen = any(map(_is_matte, materials.values())), unwrapped.paths(seen=True).grown(RIM)
    with path_scene(context) as scene, _copies(scene, lit, placed, materials, matte):
        steps = render_paths(scene, paths_seen, samples // (MATTE * dense**2) if matte else 1, matte)
        seen = yield from shown_while(steps, 0.8, RENDERING)
    yield from part(new_export_image(export_image, seen, unwrapped, dense), 0.95, 0.04)
    for mesh, own in placed.items():
        write_colours(own.mesh, spots[mesh], seen)
    if flat:
        image = yield from part(new_image(NAME, seen, whole), 0.99, 0.01)
        plain = new_material(NAME, image, image, [None], Surroundings(), whole)
        for material in materials.values():
            whole.after(forget_light, material)
        materials = dict.fromkeys(materials, plain)
    else:
        remember(image, paths, kept.age)
    told = light_record(view, unwrapped, dense)

    def show() -> None:
        for result in lit:
            mesh = result.data
            show_light(result, placed[mesh].mesh, materials[result.reflection_mesh.mirror, mesh], told, whole)
    return show


def _earlier_images(context: bpy.types.Context, lit: list, view: View, samples: int) -> list[bpy.types.Image]:
    """Return pictures of light that these show, made with as many samples, since which the view alone has changed."""
    return list(dict.fromkeys(
        image for result in lit
        if lit_with(result).get("samples", 0) >= samples and why_light_differs(context, result)
        and not light_difference(context, view, result, [], same_view=False, same_mirror=True)
        for image in images_of(result.reflection_mesh.light_material)))


def _check(lit: list) -> None:
    for result in lit:
        if not can_be_lit(result):
            raise ReflectionError(f"'{result.name}' does not know what it shows: set Attributes to All and generate it "
                                  "again.")


@contextmanager
def _copies(scene: bpy.types.Scene, lit: list, placed: dict, materials: dict, matte: bool) -> Iterator[None]:
    """Give a temporary scene copies of reflections with their light, which glossy rays alone meet; they are all that is
    in it if nothing about them is `matte`."""
    copies, everything = [], scene.collection
    if not matte:
        scene.world = None
        for kind in (everything.children, everything.objects):
            for one in list(kind):
                kind.unlink(one)
    try:
        for result in lit:
            copy = result.copy()
            copies.append(copy)
            copy.data = placed[result.data].mesh
            for slot in copy.material_slots:
                slot.link, slot.material = "OBJECT", materials[result.reflection_mesh.mirror, result.data]
            copy.visible_camera, copy.visible_glossy, copy.hide_render = False, True, False
            everything.objects.link(copy)
        yield
    finally:
        bpy.data.batch_remove(still_there(copies))


def _mirror_materials(result: bpy.types.Object) -> list[bpy.types.Material | None]:
    """Return the materials of a result's mirror that reflect; None where all of the light is shown."""
    reflecting = reflecting_materials(mirrors_of(result))
    return [None if is_plain(one) else one for one in reflecting] if not all(map(is_plain, reflecting)) else [None]


def _is_matte(material: bpy.types.Material) -> bool:
    """Return True if lamps change what a material of light shows."""
    return any(shader.type not in NOT_LIT for shader in surface_shaders(material.node_tree))
