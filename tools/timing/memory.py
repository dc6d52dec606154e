"""What a generation takes of the memory: the whole process at its peak, Blender's part included.

    python -m tools.timing.memory [1000000 ...] [--mirror 32] [--instances 5000]

The scenes are those of tools.timing.sizes, each in a process of its own; with --instances small balls of 480 faces that
stand in so many places take the knots' place. The add-on's setting Memory stays at its default.
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from tools import extension_zip
from tools.measure import print_table
from tools.timing import sizes

HEADER = ("vertices", "mirror", "instances", "faces", "seconds", "GB before", "GB at the peak")


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vertices", nargs="*", type=int, default=[1_000_000])
    parser.add_argument("--mirror", type=int, default=32, help="rings and segments of the ball (32)")
    parser.add_argument("--instances", type=int, default=0)
    parser.add_argument("--row", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.row:
        return _row(options)
    rows = []
    for count in [0] if options.instances else options.vertices:
        given = [str(count), "--row", "--mirror", str(options.mirror), "--instances", str(options.instances)]
        told = subprocess.run([sys.executable, "-m", "tools.timing.memory", *given],
                              stdout=subprocess.PIPE, text=True, check=True)
        rows.append(told.stdout.splitlines()[-1].split())
    print_table([HEADER, *rows])
    return 0


def _row(options: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as scratch:
        extension_zip.use_throw_away_preferences(Path(scratch) / "preferences")
        extension_zip.install(extension_zip.build(Path(scratch)))
        import bpy
        sizes._scene(options.vertices[0] or 10, options.mirror)
        if options.instances:
            _scatter(options.instances)
        bpy.context.view_layer.update()
        before, started = _gigabytes("VmRSS"), time.perf_counter()
        bpy.ops.reflection_mesh.generate()
        seconds, peak = time.perf_counter() - started, _gigabytes("VmHWM")
        faces = sum(len(obj.data.polygons) for obj in bpy.context.scene.objects
                    if obj.reflection_mesh.role == "REFLECTION")
        extension_zip.switch_off()
    print(options.vertices[0], 2 * options.mirror * (options.mirror - 1), options.instances, faces,
          f"{seconds:.1f} {before:.2f} {peak:.2f}")
    return 0


def _scatter(count: int) -> None:
    """Small balls in so many places round the large one, instead of the knots."""
    import bpy

    from tools.timing import sizes
    bpy.data.objects.remove(bpy.data.objects["Knots"])
    middle, rng = np.array((0.1, 0.2, 1.26)), np.random.default_rng(1)
    positions, triangles = sizes._ball(16)
    first = sizes._object("Small", (positions - middle) / 24.0, triangles, sizes._material("Small", mirror=False))
    places = rng.uniform((-3.0, -4.0, 0.0), (3.0, 1.0, 3.0), (3 * count, 3))
    for place in places[np.linalg.norm(places - middle, axis=1) > 1.4][:count]:
        obj = bpy.data.objects.new("Small", first.data)
        bpy.context.scene.collection.objects.link(obj)
        obj.location, obj.rotation_euler, obj.reflection_mesh.role = place, rng.uniform(0.0, 6.0, 3), "DIFFUSE"
    bpy.data.objects.remove(first)


def _gigabytes(entry: str) -> float:
    """Of this process, as Linux tells it."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith(entry)).split()[1]) / 1e6


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
