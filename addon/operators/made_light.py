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
    LightPaths,
    Placed,
    Unwrapped,
    alone,
    can_be_lit,
    fill_export_image,
    forget_light,
    grown,
    is_cut_out,
    is_plain,
    lay_out,
    light_record,
    new_image,
    new_material,
    only_emits,
    path_scene,
    prepared,
    remember,
    render_paths,
    show_as_cut_out,
    show_light,
    straight,
    unwrap,
    write_colours,
)
from ..mirror_part import LaterMirrors, Surroundings
from ..reading import has_fog, known_results, mirrors_of, vectors
from ..reading.materials import is_opaque, reflecting_materials, surface_shaders
from ..rendering import shown_while
from ..writing import DISC_SCALE, images_of

NAME = "Reflection Light"
RENDERING = "Rendering light"
DENSE, FEWEST = 2, 16   # texels along a pixel's side, and the samples for each pixel from which on
# Several texels of a pixel are denoised by all of its samples, so that with a half of them the room, the bathroom and
# the pond come out at most 0.15 dB farther from Cycles at 64 samples, and 0.02 dB at 128.
DENOISED = 2
EMITTED = 8             # samples of a texel that shows light without noise; the denoiser smooths what is finer than it
LEAST = 4               # samples of a texel that the denoiser needs
RIM = 4                 # texels around faces that go on as the faces do: filters and smaller copies mix them in
# Texels around faces that are rendered too, for the denoiser. In the pond at 64 samples a picture has 42.44 dB with 4,
# 42.39 with 2, 42.22 with 1 and 39.70 without any; a floor in a soft shadow at 16 samples 42.7 dB with 4, 40.6 with 2,
# and 32.3 if nothing is denoised. With 4, half of all texels are such.
RENDERED_RIM = 2
SMALL = 0.05            # of a disc's size
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
    placed = yield from _placed(lit, view, dense, whole)
    yield 0.04, "Reading the reflection"
    unwrapped = unwrap(list(placed.values()), view, dense)
    fog = has_fog(context.scene)
    paths = _paths(context, lit, unwrapped, fog)
    yield 0.08, "Reading the reflection"
    kept = KeptLight.found([] if fog else _earlier_images(context, lit, view, samples), paths)
    points = unwrapped.of_points
    light = kept.completed((yield from _rendered(context, lit, kept.missing(paths), points, samples, dense)), paths)
    image = yield from part(new_image(NAME, grown(paths.used, [light], RIM)[1], whole), 0.7, 0.05)
    clear = not all(is_opaque(one) for result in lit for one in _mirror_materials(result))
    export_image = bpy.data.images.new(f"{NAME} Export", 1, 1, alpha=clear)
    whole.undo(bpy.data.batch_remove, [export_image])
    # paths from the mirror on meet lamps themselves
    lamps, spots = [] if fog else lamps_that_show(context), dict(zip(placed, unwrapped.spots))
    first = {(result.reflection_mesh.mirror, result.data): result for result in reversed(lit)}
    materials = {key: new_material(NAME, image, export_image, _mirror_materials(result),
                                   _surroundings(result, placed[result.data].mesh, lamps), whole)
                 for key, result in first.items()}
    for key, result in first.items():
        lay_out(placed[result.data].mesh, result, view, spots[result.data], materials[key])
    matte, paths_seen = any(map(_is_matte, materials.values())), unwrapped.paths(seen=True)
    with path_scene(context) as scene, _copies(scene, lit, placed, materials, matte):
        steps = render_paths(scene, paths_seen.grown(RENDERED_RIM), samples // (MATTE * dense**2) if matte else 1,
                             matte and not points.any(), by_mirror=False)
        seen = yield from shown_while(steps, 0.8, RENDERING)
    used, seen = grown(paths_seen.used, [seen], RIM)
    if not clear:
        seen[..., 3] = 1.0
    yield from part(fill_export_image(export_image, seen, unwrapped, dense), 0.95, 0.04)
    if is_cut_out(seen[..., 3][used]):
        for material in materials.values():
            show_as_cut_out(material)
    seen = straight(seen)
    for mesh, own in placed.items():
        write_colours(own.mesh, spots[mesh], seen)
    if flat:
        plain = yield from _plain_material(lit, seen if clear else seen[..., :3], materials, whole)
        materials = dict.fromkeys(materials, plain)
    else:
        remember(image, paths, kept.age)
    told = light_record(view, unwrapped, dense)

    def show() -> None:
        for result in lit:
            mesh = result.data
            show_light(result, placed[mesh].mesh, materials[result.reflection_mesh.mirror, mesh], told, whole)
    return show


def _rendered(context: bpy.types.Context, lit: list, paths: LightPaths, points: np.ndarray, samples: int, dense: int
              ) -> Steps[np.ndarray]:
    """Render the light (h, w, 3) of paths; that of texels of `points` (h, w) is not denoised."""
    light = np.zeros_like(paths.target)
    # each point has one texel, each pixel of faces has several
    of_faces = _samples_per_texel(samples, dense)
    if all(map(only_emits, lit)) and not has_fog(context.scene):
        of_faces = min(of_faces, EMITTED)
    with path_scene(context) as scene:
        for chosen, per_texel, clean in ((points, samples, False), (~points, of_faces, True)):
            part_of_it = replace(paths, used=paths.used & chosen)
            if part_of_it.used.any():
                steps = render_paths(scene, part_of_it.grown(RENDERED_RIM) if clean else part_of_it, per_texel, clean)
                light += (yield from shown_while(steps, 0.1, RENDERING))[..., :3]
    return light


def _samples_per_texel(samples: int, dense: int) -> int:
    """Return the samples for each texel of faces, which is denoised, by those for each pixel."""
    return samples if dense == 1 else max(samples // (DENOISED * dense**2), min(samples // dense**2, LEAST))


def _placed(lit: list, view: View, dense: int, whole: AllOrNothing) -> Steps[dict[bpy.types.Mesh, Placed]]:
    """Return a prepared copy of each mesh of the reflections."""
    found: dict[bpy.types.Mesh, Placed] = {}
    for result in lit:
        if result.data not in found:
            found[result.data] = yield from part(prepared(result, view, dense, whole), 0.0, 0.0)
    return found


def _surroundings(result: bpy.types.Object, mesh: bpy.types.Mesh, lamps: list) -> Surroundings:
    mirrors = mirrors_of(result)
    return Surroundings(tuple(mirrors), lamps_before(mesh, lamps, mirrors), LaterMirrors.of(result),
                        not result.reflection_mesh.window)


def _plain_material(lit: list, seen: np.ndarray, materials: dict, whole: AllOrNothing) -> Steps[bpy.types.Material]:
    """Return a material that shows the finished picture (h, w, 3 or 4) alone, in place of `materials`."""
    image = yield from part(new_image(NAME, seen, whole), 0.99, 0.01)
    behind = Surroundings(behind=not all(result.reflection_mesh.window for result in lit))
    for material in materials.values():
        whole.after(forget_light, material)
    return new_material(NAME, image, image, [None], behind, whole)


def _paths(context: bpy.types.Context, lit: list, unwrapped: Unwrapped, fog: bool) -> LightPaths:
    """Return the light path of each texel; with `fog` it begins at the mirror."""
    shown = known_results(context.scene, context.view_layer)
    paths = unwrapped.paths(FurtherMirrors.of([one for one in shown if one.reflection_mesh.role == "REFLECTION"], lit))
    if not paths.used.any():
        raise ReflectionError("The camera sees none of the reflections: generate them again for this view.")
    return replace(paths, lead=np.full_like(paths.lead, FROM_MIRROR)) if fog else paths


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
    """Give a temporary scene copies of reflections with their light. The camera sees nothing else; nothing else is in
    the scene if nothing about them is `matte`."""
    everything, made = scene.collection, []
    if matte:
        rest = bpy.data.collections.new(NAME)
        made.append(rest)
        for obj in everything.objects:
            rest.objects.link(obj)
        everything.children.link(rest)
        _hide_from_camera(scene.view_layers[0].layer_collection)
    else:
        scene.world = None
        for one in list(everything.children):
            everything.children.unlink(one)
    for obj in list(everything.objects):
        everything.objects.unlink(obj)
    try:
        shown = {key: alone(material) for key, material in materials.items()}
        made += shown.values()
        for result in lit:
            copy = result.copy()
            made.append(copy)
            copy.data = placed[result.data].mesh
            if DISC_SCALE in copy.data.attributes:
                copy.data = _with_small_discs(copy.data)
                made.append(copy.data)
            for slot in copy.material_slots:
                slot.link, slot.material = "OBJECT", shown[result.reflection_mesh.mirror, result.data]
            copy.visible_camera, copy.hide_render = True, False
            everything.objects.link(copy)
        yield
    finally:
        bpy.data.batch_remove(still_there(made))


def _with_small_discs(mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    """Return a copy of a mesh of points whose discs do not hide the middles of others."""
    copy = mesh.copy()
    scales = vectors(copy, DISC_SCALE)
    copy.attributes[DISC_SCALE].data.foreach_set("vector", (SMALL * scales).astype(np.float32).reshape(-1))
    return copy


def _hide_from_camera(layer: bpy.types.LayerCollection) -> None:
    for child in layer.children:
        child.indirect_only = True
        _hide_from_camera(child)


def _mirror_materials(result: bpy.types.Object) -> list[bpy.types.Material | None]:
    """Return the materials of a result's mirror that reflect; None where all of the light is shown."""
    reflecting = reflecting_materials(mirrors_of(result))
    return [None if is_plain(one) else one for one in reflecting] if not all(map(is_plain, reflecting)) else [None]


def _is_matte(material: bpy.types.Material) -> bool:
    """Return True if lamps change what a material of light shows."""
    return any(shader.type not in NOT_LIT for shader in surface_shaders(material.node_tree))
