"""The main job from end to end: build the zip, install it, reflect a sample, compare with Cycles; and throw the light
of those samples whose mirrors do.

    python -m tools.demo [--sample sphere] [--folder demo] [--verbose]
"""
from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tools import extension_zip
from tools.quietly import quietly

SAMPLES = extension_zip.ROOT / "sample_blends"
THROWING = ("ring", "pool", "sunlight", "dish")


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", default="sphere", choices=sorted(path.stem for path in SAMPLES.glob("*.blend")))
    parser.add_argument("--folder", type=Path, default=Path("demo"))
    parser.add_argument("--samples-per-pixel", type=int, default=16)
    parser.add_argument("--verbose", action="store_true", help="show what Blender and Cycles tell of their work")
    options = parser.parse_args(arguments)
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_preferences_") as resources:
        extension_zip.use_throw_away_preferences(Path(resources))
        with tempfile.TemporaryFile() as log:
            try:
                report, seconds = demonstrate(options, folder, Stages(None if options.verbose else log.fileno()))
            except BaseException:
                log.seek(0)
                sys.stderr.write(log.read().decode(errors="replace"))
                raise
    displacement, coverage = report["displacement_px"], report["coverage_percent"]
    print(f"\nGenerated in {seconds:.2f} s; against Cycles: displacement {displacement['median']:.3f} px (median), "
          f"{displacement['p99']:.3f} px (99 %); holes, spill and wrong layer {coverage['all']:.3f} % of the mirror.")
    print(f"Pictures, numbers and {options.sample}.blend with its reflection: {folder}", flush=True)
    return 0


class Stages:
    """Runs one stage after another and tells of each in a line; what Blender tells goes to the file `log`, if any."""

    def __init__(self, log: int | None) -> None:
        self._log = log

    def __call__(self, name: str, work: Callable[[], Any]) -> tuple[Any, float]:
        """What `work` returns, and the seconds that it took."""
        print(f"{name} ...", end="\n" if self._log is None else " ", flush=True)
        started = time.perf_counter()
        made = work() if self._log is None else quietly(work, self._log)
        seconds = time.perf_counter() - started
        print(f"{seconds:.1f} s", flush=True)
        return made, seconds


def demonstrate(options: argparse.Namespace, folder: Path, stage: Stages) -> tuple[dict, float]:
    """Install the extension, generate, compare and save; returns the report and the seconds that generating took."""
    sample = f"{options.sample}.blend"
    zipped, _ = stage("Building the extension", lambda: extension_zip.build(folder))
    stage(f"Installing {zipped.name} into preferences that are thrown away", lambda: extension_zip.install(zipped))
    import bpy
    stage(f"Opening {sample}", lambda: bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / sample)))
    _, seconds = stage("Generating the reflection", bpy.ops.reflection_mesh.generate)
    # at once where the sample emits what it shows
    stage("Lighting it", bpy.ops.reflection_mesh.light)
    stage(f"Saving {sample} with its reflection",
          lambda: bpy.ops.wm.save_as_mainfile(filepath=str(folder / sample), copy=True))
    stage("Comparing with Cycles", lambda: bpy.ops.reflection_mesh.compare(filepath=str(folder),
                                                                           samples=options.samples_per_pixel))
    if options.sample in THROWING:
        throw_light(options, folder, stage)
    stage("Switching the extension off", extension_zip.switch_off)
    return json.loads((folder / "report.json").read_text(encoding="utf-8")), seconds


def throw_light(options: argparse.Namespace, folder: Path, stage: Stages) -> None:
    """Generate the light that the sample's mirror throws; leave a file with it, and its picture."""
    import bpy
    stage(f"Opening {options.sample}.blend again",
          lambda: bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{options.sample}.blend")))
    stage("Generating the light that its mirror throws", bpy.ops.reflection_mesh.caustics)
    stage(f"Saving {options.sample} caustics.blend", lambda: bpy.ops.wm.save_as_mainfile(
        filepath=str(folder / f"{options.sample} caustics.blend"), copy=True))
    scene = bpy.context.scene
    scene.render.filepath, scene.render.resolution_percentage = str(folder / "caustics.png"), 50
    scene.cycles.samples = options.samples_per_pixel
    stage("Rendering it with Cycles", lambda: bpy.ops.render.render(write_still=True))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
