"""How near caustics are to rays and to Cycles, and how long they take: the table of docs/caustics.md.

    python -m tools.caustics [ring waves bowl cylinder bathroom suzanne dish sunlight pool
                              goblet spoon front bridge foil can disco stairs sheets or path.blend ...]
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
from tools.caustic_scenes import fresh, measured, outside
from tools.caustic_scenes.building import lamp, take_part
from tools.measure import print_table
from tools.quietly import quietly

ROOT = extension_zip.ROOT
SAMPLES = ("ring", "dish", "sunlight", "pool")
SCENES = measured.SCENES | outside.SCENES | fresh.SCENES
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
        for name in options.scenes or (*SAMPLES, *measured.SCENES):
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
    sun = lamp("SUN", (0.0, 0.0, 5.0), (1.0, 0.0, 0.4), energy=3.0, angle=0.0)
    take_part(ring, [bpy.data.objects["Table"]], sun)
    bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT")
    result = next(obj for obj in scene.objects if obj.reflection_mesh.role == "CAUSTICS")
    lit = _room("comparison.light_of_results").Lit.of(result)
    fold = lit.positions[lit.parity == 0]
    radius = 0.5 * max(ring.dimensions[:2])
    # the light comes along the x axis
    return float(-fold[np.abs(fold[:, 1]) < 1e-3 * radius, 0].max() / radius)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
