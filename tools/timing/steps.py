"""The longest step of every operator, and of Live, on the samples: for as long the window neither draws nor hears ESC.

    python -m tools.timing.steps [sample, or a .blend, or operator ...]

Seconds are the lesser of the clock's and the processor's, so that what runs beside it counts as little as it can, and
several cores at work count once. Renders are counted apart: Blender cannot divide one, and says so before it.
"""
from __future__ import annotations

import importlib
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tools import extension_zip
from tools.quietly import quietly

ROWS = ("sample", "operator", "steps", "longest s", "in it", "longest render s")
SAMPLES = ("sphere", "flat_mirror", "cylinder", "water", "bowl", "suzanne", "mirrors", "room", "bathroom", "pond",
           "anamorphosis", "pool", "dish", "ring", "sunlight")
STEP, MOVES, LOOK = 0.02, 10, 0.02   # of Live: units, how often, seconds between two looks
CAUSTIC = ("pool", "dish", "ring", "sunlight")
# operators by what they need before them: (name, what must have run, options)
REFLECTIONS = (
    ("generate", (), {}),
    ("light", ("generate",), {"samples": 4}),
    ("mirror_uvs", (), {}),
    ("mirror_uvs", (), {"target": "ORIGINAL"}),
    ("compare", ("generate",), {"samples": 1, "what": "REFLECTIONS"}),
    ("bake", (), {"frames": "1", "samples": 4}),
    ("live", ("generate",), {}),
    ("clear", ("generate",), {}))
SHEET = (("print_sheet", ("mirror_uvs",), {"picture": "Compass", "dpi": 600.0}),)   # where one lies flat
ENDINGS = {"print_sheet": ".png"}  # of the files that operators write; others write into a folder
CAUSTICS = (
    ("caustics", (), {}),
    ("compare", ("caustics",), {"samples": 1, "what": "CAUSTICS", "converged": 8}),
    ("bake", (), {"frames": "1", "what": "CAUSTICS"}),
    ("live", ("caustics",), {}),
    ("clear", ("caustics",), {}))


class Steps:
    """The steps of operators, timed from when this is made on."""

    def __init__(self) -> None:
        self.taken: list[tuple[float, bool, str]] = []  # seconds, whether it cannot be divided, stage
        place = importlib.import_module(f"{extension_zip.PACKAGE}.addon.faults.stepped_operator")
        step, taken = place.SteppedOperator._step, self.taken

        def timed(operator) -> set | None:
            told = getattr(operator, "_progress", (0.0, ""))[1]
            outcome, seconds = lesser(partial(step, operator))
            taken.append((seconds, isinstance(told, place.Undivided), str(told)))
            return outcome
        place.SteppedOperator._step = timed

    def longest(self, undivided: bool) -> tuple[float, str]:
        """Seconds and stage of the longest of those that can be divided, or of those that cannot."""
        return max(((seconds, stage) for seconds, whole, stage in self.taken if whole == undivided),
                   default=(0.0, ""))


def lesser(work: Callable) -> tuple:
    """What `work` returns, and the lesser of the clock's and the processor's seconds that it takes."""
    begun = time.process_time(), time.perf_counter()
    return work(), min(time.process_time() - begun[0], time.perf_counter() - begun[1])


def main(names: list[str]) -> int:
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as name:
        scratch = Path(name)
        extension_zip.use_throw_away_preferences(scratch / "preferences")
        quietly(lambda: extension_zip.install(extension_zip.build(scratch)))
        steps = Steps()
        print(f"| {' | '.join(ROWS)} |\n|{'---|' * len(ROWS)}", flush=True)
        scenes = [name for name in names if name in SAMPLES or name.endswith(".blend")]
        asked = set(names) - set(scenes)
        for sample in scenes or SAMPLES:
            # of other files those of caustics where that operator is named
            caustic = sample in CAUSTIC or sample not in SAMPLES and "caustics" in asked
            jobs = CAUSTICS if caustic else REFLECTIONS + (SHEET if sample == "anamorphosis" else ())
            for job in [job for job in jobs if not asked or job[0] in asked]:
                print(f"| {' | '.join(quietly(partial(measured, sample, job, steps, scratch)))} |", flush=True)
        quietly(extension_zip.switch_off)
    return 0


def measured(sample: str, job: tuple, steps: Steps, scratch: Path) -> tuple[str, ...]:
    """One row."""
    import bpy
    name, before, options = job
    path = sample if sample.endswith(".blend") else extension_zip.ROOT / "sample_blends" / f"{sample}.blend"
    bpy.ops.wm.open_mainfile(filepath=str(path))
    for operator in before:
        getattr(bpy.ops.reflection_mesh, operator)("EXEC_DEFAULT")
    if name == "print_sheet":
        bpy.context.view_layer.objects.active = next(obj for obj in bpy.context.scene.objects if obj.type == "MESH"
                                                     and "Mirror UV" in obj.data.uv_layers)
    if name in ("compare", "bake", "print_sheet"):
        options = {**options, "filepath": str(scratch / f"{Path(sample).stem} {name}{ENDINGS.get(name, '')}")}
    steps.taken.clear()
    begun = time.perf_counter()
    try:
        if name == "live":
            steps.taken += live_steps()
        else:
            getattr(bpy.ops.reflection_mesh, name)("EXEC_DEFAULT", **options)
    except RuntimeError as refused:
        # as maps of one mirror where there are several
        return Path(sample).stem, name, str(len(steps.taken)), "–", str(refused).strip().splitlines()[0], "–"
    if not steps.taken:
        steps.taken.append((time.perf_counter() - begun, False, "all of it"))
    (seconds, stage), (render, _) = steps.longest(False), steps.longest(True)
    what = " ".join([name, *(str(value).lower() for key, value in options.items()
                             if key in ("target", "what"))])
    return Path(sample).stem, what, str(len(steps.taken)), f"{seconds:.2f}", stage, f"{render:.2f}" if render else "–"


def live_steps() -> list[tuple[float, bool, str]]:
    """Seconds of each look of Live, and what it did: the camera moves, then what is reflected, and each time all is
    made exact; then nothing can follow, and what is shown on the way is made anew."""
    import bpy
    updater = importlib.import_module(f"{extension_zip.PACKAGE}.addon.live").LiveUpdater()
    scene, taken, now = bpy.context.scene, [], 0.0

    def look(what: str) -> None:
        nonlocal now
        done, seconds = lesser(partial(updater.step, bpy.context, now))
        taken.append((seconds, False, f"{what}: {done}"))
        now += LOOK

    def rest(what: str) -> None:
        while not updater.at_rest:
            look(what)

    rest("begun")
    source = next(obj.reflection_mesh.sources[0].object for obj in scene.objects if len(obj.reflection_mesh.sources))
    for what, moved, follows in (("camera", scene.camera, True), ("object", source, True),
                                 ("anew", scene.camera, False)):
        for _ in range(MOVES):
            if not follows:
                updater.following.forget()
            moved.location.x += STEP
            bpy.context.view_layer.update()
            updater.note()
            look(what)
        rest(what)
    return taken


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
