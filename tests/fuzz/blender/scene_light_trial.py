"""One scene with lamps tried: caustics generated, generated again, cleared, and the file compared after each."""
from __future__ import annotations

import time
from collections.abc import Iterator

import bpy
import numpy as np

from tests.fuzz.blender import scene_trial
from tests.fuzz.blender.scene_lamps import built_with_lamps
from tests.fuzz.blender.scene_state import arrays, differences, digest, state, without
from tests.fuzz.blender.scenes import Scene, select

SECONDS = 90.0  # of processor time: for two lamps of several places each
NEW = ("objects", "meshes", "materials", "collections", "lights")
GLINT = "reflection_mesh_glint"
MARKS = {"materials": ("reflection_mesh_adds_light",), "collections": ("reflection_mesh_left_out", GLINT),
         "objects": (GLINT,), "lights": (GLINT,)}


def tried_lamps(seed: int) -> dict:
    """What the scene of a seed is called, how it was refused, and all that is wrong, each "what: how"."""
    scene = built_with_lamps(seed)
    before, started = _whole(), time.process_time()
    outcome = scene_trial._called("caustics", SECONDS, **scene.options)
    seconds, after, problems = time.process_time() - started, _whole(), []
    if outcome:
        problems += scene_trial._refusal_problems(outcome)
        if not outcome.startswith("time:"):
            problems += [f"changed: though refused: {one}" for one in differences(before, after)]
        return {"name": scene.name, "refusal": outcome, "problems": problems}
    results = [obj for obj in bpy.data.objects if f"object {obj.name_full} role" not in before and not obj.get(GLINT)]
    problems += [f"result: '{obj.name}': {problem}" for obj in results for problem in _result_problems(obj)]
    if not results:
        problems.append("result: finished without one")
    problems += _changes(before, after, results)
    if seconds < scene_trial.PATIENCE and not problems:
        problems += _again(scene, before, after, results)
    select([], bpy.context.view_layer.objects.active)
    outcome = scene_trial._called("clear")
    if outcome:
        return {"name": scene.name, "refusal": "", "problems": [*problems, f"clear: {outcome}"]}
    problems += [f"clear: {one}" for one in differences(without(before, "active", "selected"), _whole())]
    return {"name": scene.name, "refusal": "", "problems": problems}


def _whole() -> dict:
    """The state of the file, and what lamps light."""
    return state() | {f"lamp {obj.name_full}": getattr(obj.light_linking.receiver_collection, "name_full", None)
                      for obj in bpy.data.objects if obj.type == "LIGHT"}


def _changes(before: dict, after: dict, results: list) -> list[str]:
    """What changed beside what may be new: the results with their meshes, materials that only they use, and for
    lamps what they do not light."""
    expected = dict(before)
    new = {kind: sorted(set(after[f"data {kind}"]) - set(before[f"data {kind}"])) for kind in NEW}
    for kind, names in new.items():
        expected[f"data {kind}"] = sorted(before[f"data {kind}"] + names)
    found = []
    own = {obj.name_full for obj in results}
    if not own <= set(new["objects"]) or len(new["meshes"]) != len(results):
        found.append(f"changed: {new['objects']} and {new['meshes']} are new")
    for kind, marks in MARKS.items():
        found += [f"changed: {name!r} of {kind} is new" for name in new[kind]
                  if not (name in own or any(getattr(bpy.data, kind)[name].get(mark) for mark in marks))]
    for obj in results:
        lamp, mirror = (f"lamp {obj.reflection_mesh.lamp.name_full}",
                        f"object {obj.reflection_mesh.mirror.name_full} collections")
        if after[lamp] in new["collections"]:
            expected[lamp] = after[lamp]
            shown = [child.light_linking.receiver_collection.name_full for child in obj.reflection_mesh.lamp.children
                     if child.get(GLINT)]
            expected[mirror] = sorted({*expected[mirror], after[lamp], *shown})
    if after["active"] in own:
        expected["active"] = after["active"]
    return found + [f"changed: {one}" for one in differences(expected, after)]


def _result_problems(result: bpy.types.Object) -> Iterator[str]:
    """Blender finds nothing to mend, every number is one, and every index names something."""
    record, mesh = result.reflection_mesh, result.data
    if record.role != "CAUSTICS" or record.mirror is None or record.lamp is None:
        yield f"its role is {record.role}, its mirror {record.mirror}, its lamp {record.lamp}"
        return
    before, copy = digest(mesh), mesh.copy()
    if copy.validate(verbose=False) or copy.validate_material_indices() or digest(copy) != before:
        yield "Blender mends its mesh"
    bpy.data.meshes.remove(copy)
    values = {name.split("|")[0]: array for name, array in arrays(mesh).items()}
    for name, array in values.items():
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            yield f"{name} holds {np.count_nonzero(~np.isfinite(array))} numbers that are none"
    if not len(mesh.polygons):
        yield "it shows nothing"
    bounds = {"irradiance": (0.0, None), "caustic_light": (0.0, None), "source_object": (0, len(record.sources)),
              "source_face": (0, None), "image_parity": (-1, 2), "bounces": (1, None),
              "material_index": (0, max(1, len(mesh.materials)))}
    for name, (low, high) in bounds.items():
        array = values.get(name, np.zeros(0))
        if name not in values and name != "material_index":
            yield f"it has no {name}"
        elif array.size and (array.min() < low or (high is not None and array.max() >= high)):
            yield f"{name} reaches from {array.min()} to {array.max()}"


def _again(scene: Scene, before: dict, after: dict, results: list) -> list[str]:
    """A second run as the first updates the results in place, to the same."""
    made, names = [_made(obj) for obj in results], [obj.name_full for obj in results]
    chosen = [obj for obj in bpy.context.view_layer.objects if before.get(f"object {obj.name_full} selected")]
    select(chosen, bpy.data.objects.get(before["active"] or ""))
    outcome = scene_trial._called("caustics", SECONDS, **scene.options)
    if outcome:
        return [f"again: {outcome}"]
    # the materials are made anew
    now = _whole()
    found = [f"again: {one}" for one in differences(without(after, "active", "selected", "materials"), now)
             if not one.startswith("mesh ")]
    if len(now["data materials"]) != len(after["data materials"]):
        found.append(f"again: {len(now['data materials'])} materials, not {len(after['data materials'])}")
    if [obj.name_full for obj in results] != names or [_made(obj) for obj in results] != made:
        found.append("again: the results are others")
    return found


def _made(obj: bpy.types.Object) -> list:
    return [(name, values.tobytes()) for name, values in sorted(arrays(obj.data).items())]
