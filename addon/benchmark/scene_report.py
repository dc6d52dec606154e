"""One scene's part of the report: truth, runs, pictures, and the answer."""
from __future__ import annotations

import os
import time

import bpy
import numpy as np

from ...core import ReflectionError, Settings, reflect
from ...core.rivals import PrimaryHits, drawn_mesh, primary_hits
from ..comparison import comparison_pictures, render_pictures
from ..faults import finished
from ..judge import CodedMaterials, CopiedScene, copied_scene, mirror_all
from ..metrics import NOTHING, CodedPicture, measure
from ..reading import MirrorSurface
from ..report import Scene
from ..writing import RAYS, mesh_arrays, write_mesh
from .answer import facts, summary
from .case import Case, read_case
from .methods import METHODS
from .options import Options
from .running import Contest, run_method, with_fronts
from .truth import render_truths

SHOWN = 0.5     # tolerance of the reflection mesh in the pictures, in pixels


def scene_report(context: bpy.types.Context, name: str, folder: str, options: Options) -> Scene:
    """Benchmark the open file, which stays as it is, and write its pictures into `folder`, which is made.

    Raises
    ------
    ReflectionError
        Where nothing can be benchmarked; nothing has changed then.
    """
    started = time.perf_counter()
    case = read_case(context, options.pixels)
    hits = _least(case)
    os.makedirs(folder, exist_ok=True)
    with copied_scene(context, case.mirrors, case.diffuse, []) as copied:
        contest = Contest(case, hits, render_truths(context, copied, case))
        if not all(any(np.isfinite(truth.motion).any() for truth in truths) for truths in (
                [contest.truths.centres], contest.truths.area)):
            raise ReflectionError("The mirrors show none of the objects to the camera: move the camera or the objects.")
        judged = (contest.truths.centres, *contest.truths.area)
        options.tell(f"{name}: truth at {sum(len(truth.mirror) for truth in judged):,} places by Cycles, "
                     f"{time.perf_counter() - started:.1f} s")
        runs, skipped = [], []
        for key in options.methods or METHODS:
            since = time.perf_counter()
            found, left_out = run_method(contest, key, METHODS[key], options.budget)
            runs += found
            skipped += left_out
            options.tell(f"{name}: {METHODS[key].title}, {time.perf_counter() - since:.1f} s"
                         + "".join(f"\n    {sentence}" for sentence in left_out))
        shown, seconds = _shown(context, copied, contest, folder, options.samples)
    runs = with_fronts(runs)
    return Scene(name, summary(runs, seconds["reference"], options.samples),
                 facts(contest, seconds, options), shown, runs, tuple(skipped),
                 ((f"Cycles, {options.samples} samples", seconds["reference"]),))


def _least(case: Case) -> PrimaryHits:
    """Return the visible points of the mirror, from the fastest of three runs, as methods are timed."""
    return min((primary_hits(case.view, case.mirror, case.scene.mesh) for _ in range(3)),
               key=lambda hits: sum(hits.seconds.values()))


def _shown(context: bpy.types.Context, copied: CopiedScene, contest: Contest, folder: str,
           samples: int) -> tuple[tuple, dict]:
    """Return the pictures of the mesh for a general camera beside Cycles', and Cycles' render times."""
    case = contest.case
    result = reflect(case.view, case.mirror, case.scene.mesh, Settings(SHOWN))
    _add(copied, case, result)
    mirror_all(copied, CodedMaterials(copied, (0.0, 0.0, 0.0)).plain_mirror())
    rendered = finished(render_pictures(copied, context.scene, samples))
    picture = drawn_mesh(case.view, result, contest.hits)
    shown = picture.triangle >= 0
    triangle = np.maximum(picture.triangle, 0)
    found = CodedPicture(np.where(shown, case.scene.source_object[triangle], NOTHING), case.polygon[triangle],
                         picture.position)
    measurement = measure(*contest.truths.pictures, found)
    return finished(comparison_pictures(folder, copied.scene, rendered, measurement)), rendered.seconds


def _add(copied: CopiedScene, case: Case, result) -> None:
    """Add the reflection mesh to the copied scene, visible to the camera only, as `generate` makes it."""
    surface = MirrorSurface(case.mirror, case.triangle, np.zeros_like(case.triangle), [None])
    arrays = mesh_arrays(result, case.scene, surface, case.view)
    mesh = bpy.data.meshes.new("Benchmark")
    copied.owned.append(mesh)
    write_mesh(mesh, arrays)
    obj = bpy.data.objects.new("Benchmark", mesh)
    copied.owned.append(obj)
    obj.location = arrays.origin
    for rays in RAYS:
        setattr(obj, rays, False)
    copied.scene.collection.objects.link(obj)
    copied.results.append((obj, 0))
