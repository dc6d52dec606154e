"""How near caustics are to rays and to Cycles, and how long they take: the table of docs/caustics.md.

    python -m tools.caustics [ring waves bowl cylinder bathroom suzanne dish sunlight pool or path.blend ...]
                             [--rays 20000000] [--size 96] [--reference 2048] [--runs 3] [--no-pictures]

Rays are traced one by one from all over the mirror, by Embree, in float64 on the triangles that it names. Times are
medians of RUNS, in one process: the operator `caustics`, and four Cycles samples at 1024 x 1024. Pictures are
compared at SIZE x SIZE, over the pixels that may be lit. The sample `ring` is lit by a sun once more, to see where the
cusp of its curve lies.
"""
from __future__ import annotations

import argparse
import importlib
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tools import extension_zip
from tools.measure import print_table
from tools.quietly import quietly

ROOT = extension_zip.ROOT
ROWS = ("scene", "faces", "flux %", "rays' noise", "irradiance %", "rays' noise", "without it", "generate s",
        "4 samples s", "PSNR mesh", "PSNR Cycles", "at samples", "reference's own", "curve px")


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=[], metavar="SCENE", help=", ".join((*SCENES, *SAMPLES)))
    parser.add_argument("--rays", type=int, default=20_000_000)
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--samples", type=int, default=16, help="of the first picture of each kind")
    parser.add_argument("--reference", type=int, default=2048, help="samples of Cycles' own caustics, as converged")
    parser.add_argument("--runs", type=int, default=3, help="whose median the seconds are")
    parser.add_argument("--no-pictures", action="store_true")
    parser.add_argument("--folder", type=Path, help="keep the reports here")
    options = parser.parse_args(arguments)
    rows = []
    with extension_zip.installed() as scratch:
        for name in options.scenes or (*SAMPLES, *SCENES):
            rows.append(quietly(lambda name=name: _measured(name, options, options.folder or scratch)))
            print(f"{name}: {rows[-1]}", file=sys.stderr, flush=True)
        cusp = quietly(_cusp)
    print_table([ROWS, *rows])
    print(f"\nThe cusp of the ring in parallel light lies at {cusp:.5f} of its radius.")
    return 0


def _measured(name: str, options: argparse.Namespace, folder: Path) -> list:
    """One row of the table."""
    import bpy
    if name in SCENES:
        SCENES[name]()
    else:
        path = ROOT / "sample_blends" / f"{name}.blend" if name in SAMPLES else Path(name).resolve()
        bpy.ops.wm.open_mainfile(filepath=str(path))
    scene, name = bpy.context.scene, Path(name).stem
    scene.render.engine, scene.cycles.transparent_max_bounces = "CYCLES", 256
    scene.render.resolution_x = scene.render.resolution_y = 1024
    scene.render.resolution_percentage = 100
    generate, cycles = [], []
    for _ in range(options.runs):
        started = time.perf_counter()
        bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT")
        generate.append(time.perf_counter() - started)
        bpy.ops.reflection_mesh.clear()
        cycles.append(_four_samples())
    bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT")
    results = [obj for obj in scene.objects if obj.reflection_mesh.role == "CAUSTICS"]
    light = _against_rays(results, options.rays)
    off, noise = light["irradiance_percent"], light["irradiance_noise_percent"]
    row = [name, sum(len(obj.data.polygons) for obj in results), light["flux_percent"], light["flux_noise_percent"],
           off, noise, max(off**2 - noise**2, 0.0)**0.5, statistics.median(generate), statistics.median(cycles)]
    if options.no_pictures:
        return row + [None] * (len(ROWS) - len(row))
    scene.render.resolution_x = scene.render.resolution_y = options.size
    place = folder / name
    bpy.ops.reflection_mesh.compare(filepath=str(place), what="CAUSTICS", samples=options.samples, rays=10_000,
                                    converged=options.reference)
    report = json.loads((place / "report.json").read_text(encoding="utf-8"))
    last = {run["method"]: run for run in report["runs"]}
    mesh, own = (last[kind]["picture"]["receivers"]["psnr"] for kind in ("MESH", "CYCLES"))
    noise = report["reference"]["noise"]
    return [*row, mesh, own, last["CYCLES"]["samples"], -20.0 * float(np.log10(max(noise, 1e-12))),
            report["curve"].get("apart_median")]


def _four_samples() -> float:
    """Time for one render of the open file, four samples per pixel."""
    import bpy
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.use_denoising = 4, False
    started = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - started


def _against_rays(results: list, count: int) -> dict:
    """The errors of the result that brings most light, by Embree's rays."""
    import bpy
    light, comparing = _room("comparison.light_of_results"), _room("operators.compare_light")
    depsgraph, found = bpy.context.evaluated_depsgraph_get(), []
    for result in results:
        around = comparing._surroundings(bpy.context, depsgraph, result, results)
        steps = light.against_rays(depsgraph, result, light.Lit.of(result), around, count, by_embree)
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                found.append(stop.value)
                break
    return max(found, key=lambda one: one["flux"])


def _room(name: str):
    """A room of the extension that is installed."""
    return importlib.import_module(f"{extension_zip.PACKAGE}.addon.{name}")


def by_embree(mesh) -> Callable:
    """A tracer for `LightRays`."""
    from tests.oracles.ray_hits import first_hits

    def trace(origins: np.ndarray, directions: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        length = np.linalg.norm(directions, axis=0)
        triangle, distance = first_hits(mesh, np.ascontiguousarray(origins.T), (directions / length).T, leaving=own)
        return triangle, distance / length
    return trace


def _cusp() -> float:
    """How far from its middle, in radii, the fold of the sample `ring` comes in the plane of a sun's light."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "ring.blend"))
    scene, ring = bpy.context.scene, bpy.data.objects["Ring"]
    for obj in [obj for obj in scene.objects if obj.type == "LIGHT" or obj.name == "Dice"]:
        bpy.data.objects.remove(obj)
    sun = _lamp("SUN", (0.0, 0.0, 5.0), (1.0, 0.0, 0.4), energy=3.0, angle=0.0)
    _take_part(ring, [bpy.data.objects["Table"]], sun)
    bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT")
    result = next(obj for obj in scene.objects if obj.reflection_mesh.role == "CAUSTICS")
    lit = _room("comparison.light_of_results").Lit.of(result)
    fold = lit.positions[lit.parity == 0]
    radius = 0.5 * max(ring.dimensions[:2])
    # the light comes along the x axis
    return float(-fold[np.abs(fold[:, 1]) < 1e-3 * radius, 0].max() / radius)


def _waves() -> None:
    """A metal as wavy as water before a wall, in the sun."""
    import bpy
    count = 96
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, count), np.linspace(-2.2, 1.4, count), indexing="ij")
    z = (0.012 * np.sin(3.1 * x + 4.7 * y) + 0.010 * np.sin(-5.3 * x + 2.9 * y + 1.0) + 0.007 * np.sin(
        7.1 * x + 1.3 * y + 2.0) + 0.006 * np.sin(-2.2 * x + 8.3 * y + 0.5))
    index = np.arange(count * count).reshape(count, count)
    quads = np.stack((index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]), axis=-1).reshape(-1, 4)
    _empty((-0.8, -4.4, 1.9), (0.1, 1.0, 0.9))
    mesh = bpy.data.meshes.new("Water")
    mesh.from_pydata(np.stack((x, y, z), axis=-1).reshape(-1, 3).tolist(), [], quads.tolist())
    water = bpy.data.objects.new("Water", mesh)
    bpy.context.scene.collection.objects.link(water)
    _take_part(_metal(water), [_plain("plane", size=6.0, location=(0.0, 1.5, 2.0), rotation=(np.pi / 2, 0.0, 0.0))],
               _lamp("SUN", (0.0, 0.0, 3.0), (-0.25, -1.0, 0.9), energy=3.0, angle=0.009))


def _bowl() -> None:
    """A bowl on its side that gathers light on a wall."""
    import bpy
    _empty((-3.0, -4.5, 2.5), (0.0, 0.3, 1.0))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1.0, location=(0.0, 1.0, 1.0),
                                         rotation=(np.pi / 2, 0.0, 0.0))
    bowl = bpy.context.object
    import bmesh
    body = bmesh.new()
    body.from_mesh(bowl.data)
    bmesh.ops.delete(body, geom=[vertex for vertex in body.verts if vertex.co.z > -0.45], context="VERTS")
    body.to_mesh(bowl.data)
    body.free()
    _take_part(_metal(bowl), [_plain("plane", size=8.0), _plain("plane", size=1.0, location=(0.4, 0.6, 0.5),
                                                                rotation=(np.pi / 2, 0.0, 0.4))],
               _lamp("POINT", (0.6, -2.0, 2.2), (0.0, 1.0, 1.0), energy=200.0, shadow_soft_size=0.05))


def _cylinder() -> None:
    """A tin on a floor, in the sun."""
    import bpy
    _empty((1.5, -5.0, 4.0), (0.0, -0.8, 0.0))
    bpy.ops.mesh.primitive_cylinder_add(vertices=96, radius=0.6, depth=1.4, location=(0.0, 0.0, 0.7))
    _take_part(_metal(bpy.context.object), [_plain("plane", size=9.0)],
               _lamp("SUN", (0.0, 0.0, 5.0), (-0.5, -2.0, 1.5), energy=3.0, angle=0.009))


def _bathroom() -> None:
    """A tilted mirror over a basin, and a window's light that it throws on floor and wall."""
    import bpy
    _empty((3.0, -4.0, 3.0), (0.0, 0.0, 0.6))
    bpy.ops.mesh.primitive_plane_add(size=1.2, location=(0.0, 1.4, 1.6), rotation=(1.5, 0.0, 0.0))
    mirror = bpy.context.object
    basin = _plain("cylinder", radius=0.35, depth=0.2, location=(0.1, 0.9, 0.8), vertices=48)
    _take_part(_metal(mirror), [_plain("plane", size=6.0), basin, _plain("plane", size=6.0, location=(0.0, 1.5, 2.0),
                                                                         rotation=(np.pi / 2, 0.0, 0.0))],
               _lamp("SPOT", (1.0, -2.5, 3.2), (0.0, 1.4, 1.6), energy=300.0, shadow_soft_size=0.05, spot_size=0.6))


def _suzanne() -> None:
    """A monkey of chrome on a floor."""
    import bpy
    _empty((2.5, -4.5, 3.5), (0.0, -0.8, 0.4))
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(0.0, 0.2, 0.8), rotation=(-0.4, 0.0, 0.0))
    monkey = bpy.context.object
    monkey.modifiers.new("Smooth", "SUBSURF").levels = 1
    _take_part(_metal(monkey), [_plain("plane", size=8.0)],
               _lamp("POINT", (1.6, -2.4, 2.2), (0.0, 0.0, 0.8), energy=200.0, shadow_soft_size=0.05))


SAMPLES = ("ring", "dish", "sunlight", "pool")
SCENES = {"waves": _waves, "bowl": _bowl, "cylinder": _cylinder, "bathroom": _bathroom, "suzanne": _suzanne}


def _empty(eye: tuple, target: tuple) -> None:
    """An empty file with a camera and without a world."""
    import bpy
    from mathutils import Vector
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, camera.location = camera, eye
    camera.rotation_euler = (Vector(target) - camera.location).to_track_quat("-Z", "Y").to_euler()


def _lamp(kind: str, place: tuple, target: tuple, **values):
    import bpy
    from mathutils import Vector
    data = bpy.data.lights.new("Lamp", kind)
    for name, value in values.items():
        setattr(data, name, value)
    lamp = bpy.data.objects.new("Lamp", data)
    bpy.context.scene.collection.objects.link(lamp)
    lamp.location = place
    # a sun's target is where it stands
    way = Vector(target) - lamp.location if kind != "SUN" else -Vector(target)
    lamp.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    return lamp


def _material(name: str, kind: str, colour: tuple):
    import bpy
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    shader.inputs["Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = 0.0
    return made


def _metal(obj):
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    obj.data.materials.append(_material("Metal", "ShaderNodeBsdfGlossy", (0.9, 0.9, 0.9)))
    return obj


def _plain(kind: str, **values):
    import bpy
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**values)
    obj = bpy.context.object
    obj.data.materials.append(_material("Plaster", "ShaderNodeBsdfDiffuse", (0.8, 0.8, 0.8)))
    return obj


def _take_part(mirror, receivers: list, lamp) -> None:
    import bpy
    bpy.context.view_layer.update()
    for obj in bpy.context.scene.objects:
        obj.select_set(obj in (mirror, *receivers, lamp))
    bpy.context.view_layer.objects.active = mirror


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
