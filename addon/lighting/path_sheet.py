"""Render the light that arrives along given paths: a flat sheet whose texels are Ray Portals into the user's scene.

Cycles' Ray Portal BSDF (Blender 4.2) lets a ray go on elsewhere in another direction. A temporary camera looks at a
small perfect mirror, in which it sees a sheet of portals, one for each texel. Each portal leads to just before the
point whose light is looked for. So Cycles shades that point as a mirror sees it, with gloss, Fresnel, bump and
transparency, and counts the mirror as one bounce, but never traces the user's mirror.
"""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import bpy
import numpy as np
from mathutils import Vector

from .. import compat
from ..reading import has_fog
from ..rendering import Renders, copied_scene, denoise, look_through, only_the_picture, put_swift_world, rendering
from ..writing.nodes.shader_builder import ShaderBuilder
from .light_paths import LightPaths

NAME = "Reflection Light"
UV = "Texel"
AWAY = 4.0      # radii of the scene between its middle and the sheet
BESIDE, SMALL = 0.1, 0.004  # in fog: shares of a path between the mirror and the sheet, and of it as the sheet's size
SEEN_BY = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter",
           "visible_shadow")
EVEN = 0.5      # between whole numbers
TILE = 8        # texels along the side of a tile; tiles without used texels are left out
# noise threshold of Cycles' adaptive sampling from which on the denoiser does the rest, and the samples before it
NOISE, LEAST = 0.1, 8


@contextmanager
def path_scene(context: bpy.types.Context) -> Iterator[bpy.types.Scene]:
    """Give a copy of the user's scene for `render_paths`, until it is left.

    Reflections are in it, but no light path meets them: glossy rays do not see them.
    """
    with copied_scene(context, NAME) as (scene, back):
        only_the_picture(scene.render)
        scene.render.use_border = False
        scene.cycles.film_exposure, scene.cycles.film_transparent_glass = 1.0, False
        scene.cycles.pixel_filter_type = "BOX"
        if hasattr(scene.cycles, "dicing_camera"):
            scene.cycles.dicing_camera = scene.camera
        put_swift_world(scene, back)
        yield scene


def render_paths(scene: bpy.types.Scene, paths: LightPaths, samples: int, clean: bool, by_mirror: bool = True
                 ) -> Renders[np.ndarray]:
    """Render the light that arrives along `paths`, (h, w, 4) float32: linear light, and opacity; 0 where no path is.

    Parameters
    ----------
    scene : bpy.types.Scene
        From `path_scene`.
    samples : int
        For each texel.
    clean : bool
        Denoise the picture.
    by_mirror : bool
        Paths are those of a mirror's glossy rays. Others are those of the camera's own rays; they also tell opacity.
    """
    height, width = paths.used.shape
    with ExitStack() as back:
        radius, place = _bounds(scene)
        if has_fog(scene):
            radius, place = _in_the_fog(paths, radius)
        else:
            place -= Vector((0.0, 0.0, AWAY * radius))
        camera = bpy.data.objects.new(NAME, bpy.data.cameras.new(NAME))
        look_through(scene, camera, back)
        camera.data.type, camera.data.sensor_fit = "ORTHO", "HORIZONTAL" if width >= height else "VERTICAL"
        camera.data.ortho_scale = radius
        camera.data.clip_start, camera.data.clip_end = 0.1 * radius, 2.0 * radius
        camera.location = place
        size = radius * np.array((width, height)) / max(width, height)
        images = _images(paths, back)
        # the camera looks down at a mirror, in which it sees the sheet above itself
        tiles, portals = _tiles(paths.used), _portals(images, (width, height), back)
        planes = [(portals, 0.5, "visible_glossy"), (_perfect_mirror(back), -0.5, "visible_camera")]
        for material, above, rays in planes if by_mirror else [(portals, -0.5, "visible_camera")]:
            plane = _plane(scene, tiles, size, place, above * radius, back)
            plane.data.materials.append(material)
            for name in SEEN_BY:
                setattr(plane, name, name == rays)
        render = scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
        render.pixel_aspect_x = render.pixel_aspect_y = 1.0
        # beside the mirror nothing is shaded
        render.film_transparent = True
        scene.cycles.samples, scene.cycles.use_denoising = max(samples, 1), False
        if clean:
            denoise(scene.cycles)
            # the quality "FAST" would take a tenth of the time less, but shows 0.1 % of pixels of plain colours wrong
            scene.cycles.denoising_prefilter = "FAST"
            _stop_early(scene.cycles)
        light = yield from rendering(scene)
        light[..., :3] *= paths.left
        return light * paths.used[..., None]


def _stop_early(cycles: bpy.types.PropertyGroup) -> None:
    """Let adaptive sampling, if the user has it on, stop at the noise that denoising removes."""
    cycles.adaptive_min_samples = LEAST
    if cycles.use_denoising:
        cycles.adaptive_threshold = max(cycles.adaptive_threshold, NOISE)


def _bounds(scene: bpy.types.Scene) -> tuple[float, Vector]:
    """Return the radius and the middle of a ball around the scene's objects."""
    corners = np.array([obj.matrix_world @ Vector(corner) for obj in scene.objects for corner in obj.bound_box]
                       or [(0.0, 0.0, 0.0)], dtype=np.float64)
    corners = corners[np.isfinite(corners).all(axis=1)]
    low, high = corners.min(axis=0), corners.max(axis=0)
    return max(0.5 * float(np.linalg.norm(high - low)), 1e-3), Vector((0.5 * (low + high)).tolist())


def _in_the_fog(paths: LightPaths, radius: float) -> tuple[float, Vector]:
    """Return how large a sheet is, and where it lies, that stands in the same fog as the mirror: Cycles knows what is
    around a ray where a camera stands, and a portal changes nothing of that.

    It lies on a light path, where nothing else is, and is small.
    """
    line = (paths.target - paths.origin)[paths.used].astype(np.float64)
    length = np.linalg.norm(line, axis=1)
    middle = np.argsort(length)[len(length) // 2]
    size = min(float(length[middle]), radius)
    ahead = line[middle] / max(float(length[middle]), 1e-30)
    return SMALL * size, Vector((paths.origin[paths.used][middle] + BESIDE * size * ahead).tolist())


def _images(paths: LightPaths, back: ExitStack) -> list[bpy.types.Image]:
    """Return images of the targets, the origins, and the targets' changes; in alpha whether, and the lead."""
    height, width = paths.used.shape
    across, up = paths.spread[..., :1] * paths.across, paths.spread[..., 1:] * paths.up
    made = []
    for name, vectors, alpha in (("Target", paths.target, paths.used), ("Origin", paths.origin, paths.lead),
                                 ("Across", across, 1.0), ("Up", up, 1.0)):
        image = bpy.data.images.new(f"{NAME} {name}", width, height, alpha=True, float_buffer=True, is_data=True)
        back.callback(bpy.data.images.remove, image)
        image.alpha_mode = "CHANNEL_PACKED"
        values = np.empty((height, width, 4), dtype=np.float32)
        values[..., :3], values[..., 3] = vectors, alpha
        image.pixels.foreach_set(values.reshape(-1))
        made.append(image)
    return made


def _tiles(used: np.ndarray) -> np.ndarray:
    """Return the corners (n, 4, 2) of tiles that have used texels, in shares of the picture's width and height."""
    starts = [np.arange(0, side, TILE) for side in used.shape]
    row, column = np.nonzero(np.logical_or.reduceat(np.logical_or.reduceat(used, starts[0], axis=0), starts[1], axis=1))
    corners = np.stack((column, row), axis=1)[:, None] + ((0, 0), (1, 0), (1, 1), (0, 1))
    return np.minimum(corners * TILE / used.shape[::-1], 1.0)


def _plane(scene: bpy.types.Scene, tiles: np.ndarray, size: np.ndarray, place: Vector, above: float, back: ExitStack
           ) -> bpy.types.Object:
    """Add tiles of a rectangle of that size, `above` a place, whose texels lie as the camera sees them."""
    mesh = bpy.data.meshes.new(NAME)
    back.callback(bpy.data.meshes.remove, mesh)
    places = np.zeros((4 * len(tiles), 3))
    places[:, :2] = ((tiles - 0.5) * size).reshape(-1, 2)
    mesh.from_pydata(places, [], np.arange(len(places)).reshape(-1, 4))
    mesh.uv_layers.new(name=UV).uv.foreach_set("vector", tiles.astype(np.float32).reshape(-1))
    obj = bpy.data.objects.new(NAME, mesh)
    obj.location = place + Vector((0.0, 0.0, above))
    scene.collection.objects.link(obj)
    return obj


def _perfect_mirror(back: ExitStack) -> bpy.types.Material:
    material, build = _material(back)
    glossy = build.add("ShaderNodeBsdfAnisotropic")
    glossy.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    glossy.inputs["Roughness"].default_value = 0.0
    build.feed(glossy.outputs[0], build.add("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _portals(images: list, size: tuple[int, int], back: ExitStack) -> bpy.types.Material:
    """Return a material that lets rays go on along the paths that `images` hold; others pass it by."""
    material, build = _material(back)
    spot = build.add("ShaderNodeUVMap", uv_map=UV).outputs[0]
    looks = []
    for image in images:
        look = build.add("ShaderNodeTexImage", image=image, interpolation="Closest", extension="EXTEND")
        build.feed(spot, look.inputs["Vector"])
        looks.append(look)
    target, origin, across, up = (look.outputs["Color"] for look in looks)
    # samples are spread over the texel
    within = build.separated(build.vector("FRACTION", build.vector("MULTIPLY", spot, (*map(float, size), 0.0))))
    for change, share in zip((across, up), within):
        target = build.vector("ADD", target, build.vector("SCALE", change,
                                                          Scale=build.calculated("SUBTRACT", share, EVEN)))
    # a share of the line: one that begins at the mirror must not begin behind it where the target is moved
    line = build.vector("SUBTRACT", target, origin)
    before = build.calculated("SUBTRACT", 1.0, looks[1].outputs["Alpha"])
    start = build.vector("ADD", origin, build.vector("SCALE", line, Scale=before))
    ahead = build.vector("NORMALIZE", line)
    portal = build.add("ShaderNodeBsdfRayPortal")
    for value, name in (((1.0, 1.0, 1.0, 1.0), "Color"), (start, "Position"), (ahead, "Direction")):
        build.feed(value, portal.inputs[name])
    shown = build.mixed(looks[0].outputs["Alpha"], build.glow((0.0, 0.0, 0.0, 1.0)), portal.outputs[0])
    # rays of the scene that happen to come by are of a later bounce, or have passed a portal
    path = build.add("ShaderNodeLightPath").outputs
    own = build.calculated("MULTIPLY",
                           build.calculated("LESS_THAN", path["Ray Depth"], 1.0 + EVEN),
                           build.calculated("LESS_THAN", path["Transparent Depth"], EVEN))
    clear = build.add("ShaderNodeBsdfTransparent").outputs[0]
    build.feed(build.mixed(own, clear, shown), build.add("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _material(back: ExitStack) -> tuple[bpy.types.Material, ShaderBuilder]:
    material = bpy.data.materials.new(NAME)
    back.callback(bpy.data.materials.remove, material)
    tree = compat.use_nodes(material)
    tree.nodes.clear()
    return material, ShaderBuilder(tree)
