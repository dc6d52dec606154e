"""What Live takes on the samples, as the table of docs/live.md.

    python -m tools.timing.live_rate [name ...]

The camera goes sideways, 2 cm before each update, until 20 updates have followed it; then all is made exact. Times are
those of the processor, both cores together, so that what runs beside it counts as little as it can, and medians.
"""
from __future__ import annotations

import importlib
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from tools import extension_zip
from tools.quietly import quietly

ROWS = ("sample", "faces", "on the way ms", "a second", "made anew ms", "exact ms")
SAMPLES = ("sphere", "flat_mirror", "cylinder", "water", "bowl", "suzanne", "mirrors", "room", "bathroom", "pond")
STEP, MOVES, LOOK = 0.02, 20, 0.02


def main(names: list[str]) -> int:
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as scratch:
        extension_zip.use_throw_away_preferences(Path(scratch) / "preferences")
        quietly(lambda: extension_zip.install(extension_zip.build(Path(scratch))))
        print(f"| {' | '.join(ROWS)} |\n|{'---|' * len(ROWS)}", flush=True)
        for name in names or SAMPLES:
            print(f"| {' | '.join(measured(name))} |", flush=True)
    return 0


def measured(name: str) -> list[str]:
    """One row."""
    import bpy
    updater_of = importlib.import_module(f"{extension_zip.PACKAGE}.addon.live").LiveUpdater
    path = extension_zip.ROOT / "sample_blends" / f"{name}.blend"
    quietly(lambda: bpy.ops.wm.open_mainfile(filepath=str(path)))
    quietly(lambda: bpy.ops.reflection_mesh.generate("EXEC_DEFAULT"))
    faces = sum(obj.reflection_mesh.faces for obj in bpy.context.scene.objects)
    updater, now, taken = updater_of(), 0.0, {}

    def look() -> str:
        nonlocal now
        done = updater.step(bpy.context, now)
        now += LOOK
        return done

    def update() -> float:
        """Milliseconds of one update, however many looks it takes."""
        started = time.process_time()
        while (done := look()) == "working":
            pass
        seconds = time.process_time() - started
        taken.setdefault(done, []).append(seconds)
        return 1000.0 * seconds

    def rest() -> float:
        """Milliseconds of work until all is exact."""
        started = time.process_time()
        while not updater.at_rest:
            look()
        return 1000.0 * (time.process_time() - started)

    rest()
    moves = 0
    while len(taken.get("followed", ())) < MOVES and moves < 3 * MOVES:
        moves += 1
        bpy.context.scene.camera.location.x += STEP
        bpy.context.view_layer.update()
        updater.note(False)
        update()
    followed = 1000.0 * median(taken["followed"]) if "followed" in taken else None
    exact = rest()
    updater.following.tracks, updater._pace.tolerance = [], 16.0
    bpy.context.scene.camera.location.x += STEP
    bpy.context.view_layer.update()
    updater.note(False)
    anew = update()
    way = ["–", "–"] if followed is None else [f"{followed:.0f}", f"{1000.0 / followed:.0f}"]
    return [name, str(faces), *way, f"{anew:.0f}", f"{exact:.0f}"]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
