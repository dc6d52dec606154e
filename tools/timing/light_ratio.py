"""Compare the time of Light Reflection with that of a Cycles render of the frame with as many samples.

    python -m tools.timing.light_ratio [room bathroom pond] [--rounds 3] [--side 512] [--samples 64]

Both run in turn, in processor seconds of all cores. Machines are noisy, so medians of a few rounds are compared. Cycles
renders the mirrors as the file has them, without the reflections: once without denoising, and once with the denoiser
that light has, which is what Blender does by default.
"""
from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from functools import partial

from tools import extension_zip
from tools.quietly import quietly

SAMPLES = ("room", "bathroom", "pond")
ROWS = ("sample", "Cycles s", "denoised s", "light s", "ratio", "ratio to denoised", "stages s")


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", default=SAMPLES)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--side", type=int, default=512, help="pixels along the picture's sides")
    parser.add_argument("--samples", type=int, default=64)
    options = parser.parse_args(arguments)
    print(f"| {' | '.join(ROWS)} |\n|{'---|' * len(ROWS)}", flush=True)
    with extension_zip.installed():
        for name in options.names:
            print(f"| {' | '.join(quietly(partial(measured, name, options)))} |", flush=True)
    return 0


def measured(name: str, options: argparse.Namespace) -> tuple[str, ...]:
    """Return one row of the table."""
    import bpy
    from bl_ext.user_default.reflection_mesh.addon.operators.light import lighting
    from bl_ext.user_default.reflection_mesh.addon.rendering import denoise
    bpy.ops.wm.open_mainfile(filepath=str(extension_zip.ROOT / "sample_blends" / f"{name}.blend"))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = options.side
    scene.render.resolution_percentage = 100
    bpy.ops.reflection_mesh.generate("EXEC_DEFAULT")
    results = [obj for obj in scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    cycles, denoised, stages, lights = [], [], {}, []
    for _ in range(options.rounds):
        for result in results:
            result.hide_render = True
        cycles.append(_render(scene, options.samples))
        denoised.append(_render(scene, options.samples, denoise))
        for result in results:
            result.hide_render = False
        begun, stage = time.process_time(), "Reading the scene"
        lights.append(0.0)
        for _, told in lighting(bpy.context, results, options.samples, every=True):
            now = time.process_time()
            stages[stage] = stages.get(stage, 0.0) + (now - begun) / options.rounds
            lights[-1] += now - begun
            begun, stage = now, str(told)
        now = time.process_time()
        stages[stage], lights[-1] = stages.get(stage, 0.0) + (now - begun) / options.rounds, lights[-1] + now - begun
    one, two, other = (statistics.median(each) for each in (cycles, denoised, lights))
    told = ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in stages.items())
    return (name, f"{one:.2f}", f"{two:.2f}", f"{other:.2f}",
            f"{other / one:.2f}", f"{other / two:.2f}", told)


def _render(scene, samples: int, denoise: Callable | None = None) -> float:
    """Return the processor seconds of a render of the file; `denoise` changes its settings so that it is denoised."""
    import bpy
    copy = scene.copy()
    try:
        copy.cycles.samples, copy.cycles.use_denoising = samples, False
        if denoise is not None:
            denoise(copy.cycles)
        copy.render.engine = "CYCLES"
        begun = time.process_time()
        bpy.ops.render.render(scene=copy.name)
        return time.process_time() - begun
    finally:
        bpy.data.scenes.remove(copy)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
