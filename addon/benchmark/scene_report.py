"""One scene's part of the report: truth, runs, pictures, and the answer."""
from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, Settings, reflect
from ...core.rivals import PrimaryHits, primary_hits
from ...core.rivals.forward import drawn_mesh
from ..blender_data import RAYS, mesh_arrays, origin_of, write_mesh
from ..comparison import comparison_pictures, pictures
from ..faults import finished
from ..judge import CodedMaterials, CopiedScene, copied_scene, dress, reflecting
from ..metrics import NOTHING, CodedPicture, measure
from ..report import Scene
from .answer import facts, summary
from .case import Case, read_case
from .methods import METHODS
from .running import run_method, with_fronts
from .truth import render_truths

SHOWN = 0.5     # tolerance of the reflection mesh in the pictures, in pixels


@dataclass(frozen=True)
class Options:
    """What a benchmark runs.

    Attributes
    ----------
    methods : tuple of str
        Keys of `METHODS`; all where empty.
    budget : float
        Seconds for each value of a method's knob, on each scene.
    pixels : int or None
        The picture's longer side; the render's own where None.
    samples : int
        Per pixel of the two pictures.
    tell : callable
        Is told what is done, a line at a time.
    """

    methods: tuple = ()
    budget: float = 10.0
    pixels: int | None = None
    samples: int = 4
    tell: Callable[[str], None] = print

    def __post_init__(self) -> None:
        unknown = [name for name in self.methods if name not in METHODS]
        if unknown:
            raise ReflectionError(f"There is no method '{unknown[0]}': choose from {', '.join(METHODS)}.")
        if not self.budget >= 0.0:
            raise ReflectionError("The budget must be a number of seconds, zero or more.")
        if self.samples < 1:
            raise ReflectionError("A picture takes at least one sample: raise --samples.")


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
        centres, area, coded = render_truths(context, copied, case)
        options.tell(f"{name}: truth at {sum(len(truth.mirror) for truth in (centres, *area)):,} places by Cycles, "
                     f"{time.perf_counter() - started:.1f} s")
        runs, skipped = [], []
        for key in options.methods or METHODS:
            since = time.perf_counter()
            found, left_out = run_method(case, key, METHODS[key], hits, centres, area, options.budget)
            runs += found
            skipped += left_out
            options.tell(f"{name}: {METHODS[key].title}, {time.perf_counter() - since:.1f} s"
                         + "".join(f"\n    {sentence}" for sentence in left_out))
        shown, seconds = _shown(context, copied, case, hits, coded, folder, options)
    runs = with_fronts(runs)
    return Scene(name, summary(runs, seconds["reference"], options.samples),
                 facts(case, hits, centres, seconds, options), shown, runs, tuple(skipped),
                 ((f"Cycles, {options.samples} samples", seconds["reference"]),))


def _least(case: Case) -> PrimaryHits:
    """What the eye sees, in the quickest of three runs, as methods are timed."""
    return min((primary_hits(case.view, case.mirror, case.scene.mesh) for _ in range(3)),
               key=lambda hits: sum(hits.seconds.values()))


def _shown(context: bpy.types.Context, copied: CopiedScene, case: Case, hits: PrimaryHits, coded: tuple, folder: str,
           options: Options) -> tuple[tuple, dict]:
    """The pictures of the general camera's mesh beside Cycles', and Cycles' seconds for them."""
    mirror, bent, truth = coded
    result = reflect(case.view, case.mirror, case.scene.mesh, Settings(SHOWN))
    _add(copied, case, result)
    dress([(copy, index) for copy, index in copied.mirrors if not reflecting(copy)],
          CodedMaterials(copied, (0.0, 0.0, 0.0)).plain_mirror())
    reference, drawn, seconds = finished(pictures(copied, context.scene, options.samples))
    picture = drawn_mesh(case.view, result, hits)
    shown = picture.triangle >= 0
    triangle = np.maximum(picture.triangle, 0)
    found = CodedPicture(np.where(shown, case.scene.source_object[triangle], NOTHING), case.polygon[triangle],
                         picture.position)
    return finished(comparison_pictures(folder, copied.scene, reference, drawn, mirror,
                                        measure(mirror, bent, truth, found))), seconds


def _add(copied: CopiedScene, case: Case, result) -> None:
    """The reflection mesh as an object of the copied scene, seen by the camera only, as `generate` makes it."""
    origin = origin_of(case.mirror)
    mesh = bpy.data.meshes.new("Benchmark")
    copied.owned.append(mesh)
    write_mesh(mesh, mesh_arrays(result, case.scene, case.triangle, origin))
    obj = bpy.data.objects.new("Benchmark", mesh)
    copied.owned.append(obj)
    obj.location = origin
    for rays in RAYS:
        setattr(obj, rays, False)
    copied.scene.collection.objects.link(obj)
    copied.results.append((obj, 0))
