"""The main job from end to end: build the zip, install it, reflect a sample, compare with Cycles.

    python benchmarks/demo.py [--sample sphere] [--folder demo]
"""
from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
import time
from pathlib import Path

import extension_zip

SAMPLES = extension_zip.ROOT / "sample_blends"


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", default="sphere", choices=sorted(path.stem for path in SAMPLES.glob("*.blend")))
    parser.add_argument("--folder", type=Path, default=Path("demo"))
    parser.add_argument("--samples-per-pixel", type=int, default=16)
    options = parser.parse_args(arguments)
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    resources = Path(tempfile.mkdtemp(prefix="reflection_mesh_preferences_"))
    try:
        extension_zip.use_throw_away_preferences(resources)
        report, seconds = demonstrate(options.sample, folder, options.samples_per_pixel)
    finally:
        shutil.rmtree(resources)
    displacement, coverage = report["displacement_px"], report["coverage_percent"]
    print(f"\nGenerated in {seconds:.2f} s; against Cycles: displacement {displacement['median']:.3f} px (median), "
          f"{displacement['p99']:.3f} px (99 %); holes, spill and wrong layer {coverage['all']:.3f} % of the mirror.")
    print(f"Pictures, numbers and {options.sample}.blend with its reflection: {folder}")
    return 0


def demonstrate(sample: str, folder: Path, samples_per_pixel: int) -> tuple[dict, float]:
    """Install the extension, generate, compare and save; returns the report and the seconds that generating took."""
    import bpy
    zipped = extension_zip.build(folder)
    print(f"Built {zipped.name}", flush=True)
    extension_zip.install(zipped)
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{sample}.blend"))
    started = time.perf_counter()
    bpy.ops.reflection_mesh.generate()
    seconds = time.perf_counter() - started
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{sample}.blend"), copy=True)
    bpy.ops.reflection_mesh.compare(filepath=str(folder), samples=samples_per_pixel)
    extension_zip.switch_off()
    return json.loads((folder / "report.json").read_text(encoding="utf-8")), seconds


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
