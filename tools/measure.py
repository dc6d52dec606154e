"""One table over the samples: errors against Cycles, and the time to generate beside Cycles' time for one sample.

    python -m tools.measure [name or path of a .blend ...] [--tolerance 0.5] [--runs 3] [--folder FOLDER]

Cycles is timed on the file as it is, and with a world of one colour in its place ("plain"), at its own resolution, one
sample per pixel, in the same process; all times are medians over the runs.
Judge on Blender 4.5: Cycles 5.2 packs shading normals and so moves its own reflections.
"""
from __future__ import annotations

import argparse
import importlib
import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from tools import extension_zip
from tools.quietly import quietly

ROWS = ("sample", "vertices", "faces", "median px", "p95 px", "p99 px", "max px", "hole %", "spill %", "wrong %",
        "all %", "RMSE", "generate s", "Cycles s", "ratio", "plain s", "plain ratio")


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", help="NAME:DEPTH follows more than one bounce", default=[
        "sphere", "flat_mirror", "cylinder", "water", "bowl", "suzanne", "mirrors", "mirrors:2", "room", "bathroom",
        "pond"])
    parser.add_argument("--tolerance", type=float, default=0.5)
    parser.add_argument("--placement", default="LAYERED")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--folder", type=Path, help="keep pictures and reports here")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as scratch:
        extension_zip.use_throw_away_preferences(Path(scratch) / "preferences")
        quietly(lambda: extension_zip.install(extension_zip.build(Path(scratch))))
        rows = []
        for scene in options.scenes:
            scene, _, depth = scene.partition(":")
            path = Path(scene) if scene.endswith(".blend") else extension_zip.ROOT / "sample_blends" / f"{scene}.blend"
            folder = (options.folder or Path(scratch)).resolve() / (path.stem + depth)
            rows.append(quietly(lambda path=path, folder=folder, depth=int(depth or 1):
                                measure(path.resolve(), folder, depth, options)))
            print(f"{path.stem}: done", file=sys.stderr, flush=True)
        quietly(extension_zip.switch_off)
    import bpy
    print(f"Blender {bpy.app.version_string}, tolerance {options.tolerance:g} px, {os.cpu_count()} threads\n")
    print_table([ROWS, *rows])
    return 0


def measure(path: Path, folder: Path, depth: int, options: argparse.Namespace) -> list:
    """One row of the table; leaves the comparison's pictures and report in `folder`."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(path))
    cycles = [_cycles_seconds() for _ in range(options.runs)]
    bpy.context.scene.world = bpy.data.worlds.new("Plain")
    plain = [_cycles_seconds() for _ in range(options.runs)]
    generate = []
    for _ in range(options.runs):
        bpy.ops.wm.open_mainfile(filepath=str(path))
        bpy.context.evaluated_depsgraph_get()
        started = time.perf_counter()
        bpy.ops.reflection_mesh.generate(tolerance=options.tolerance, placement=options.placement, depth=depth)
        generate.append(time.perf_counter() - started)
    lighting = importlib.import_module(extension_zip.PACKAGE + ".addon.lighting")
    results = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    sources = {source.object for result in results for source in result.reflection_mesh.sources}
    bpy.ops.reflection_mesh.compare(filepath=str(folder), samples=4)
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    moved, share = report["displacement_px"], report["coverage_percent"]
    seconds, reference, of_plain = map(statistics.median, (generate, cycles, plain))
    name = path.stem if depth == 1 else f"{path.stem}, depth {depth}"
    return [name, sum(len(obj.data.vertices) for obj in sources if obj.type == "MESH"),
            sum(len(result.data.polygons) for result in results),
            *(moved[key] for key in ("median", "p95", "p99", "max")),
            *(share[key] for key in ("hole", "spill", "wrong_layer", "all")),
            # what lamps light is judged with its light, elsewhere
            None if any(map(lighting.needs_light, results)) else report["picture"]["mirror"]["rmse"],
            seconds, reference, reference / seconds, of_plain, of_plain / seconds]


def _cycles_seconds() -> float:
    """Time for one render of the open file, one sample per pixel."""
    import bpy
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 1, False
    started = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - started


def print_table(rows: list) -> None:
    """A table in Markdown, its head first."""
    cells = [[_cell(value) for value in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells)]
    for index, row in enumerate(cells):
        print("| " + " | ".join(cell.rjust(width) if k else cell.ljust(width)
                                for k, (cell, width) in enumerate(zip(row, widths))) + " |")
        if not index:
            print("|" + "|".join("-" * (width + 1) + (":" if k else "-") for k, width in enumerate(widths)) + "|")


def _cell(value) -> str:
    if isinstance(value, float):
        return f"{value:.4f}" if abs(value) < 0.01 else f"{value:.3f}" if value < 100.0 else f"{value:.0f}"
    return "-" if value is None else str(value)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
