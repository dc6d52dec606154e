"""One scene tried: generated, generated again, cleared, and the file compared after each."""
from __future__ import annotations

import re
import time

import bpy

from tests.fuzz.blender.scene_checks import disc_problems, result_problems
from tests.fuzz.blender.scene_state import differences, digest, state, without
from tests.fuzz.blender.scenes import Scene, built, select
from tests.fuzz.limits import TooLong, at_most, peak_gigabytes

SECONDS = 30.0  # of processor time, to generate
PATIENCE = 5.0  # seconds: what takes longer is not done again
GIGABYTES = 2.5  # what the settings allow by default, and room
SENTENCE = re.compile(r"(Error: )?['A-ZÄÖÜ][^\n]*\.")


def tried_scene(seed: int) -> dict:
    """What the scene of a seed is called, how it was refused, and all that is wrong, each "what: how"."""
    scene = built(seed)
    before, peak, started = state(), peak_gigabytes(), time.process_time()
    outcome = _called("generate", **scene.options)
    seconds, after, problems = time.process_time() - started, state(), []
    if peak_gigabytes() - peak > GIGABYTES:
        problems.append(f"memory: {peak_gigabytes() - peak:.1f} GB more than before")
    if outcome:
        problems += _refusal_problems(outcome)
        if not outcome.startswith("time:"):
            problems += [f"changed: though refused: {one}" for one in differences(before, after)]
        return {"name": scene.name, "refusal": outcome, "problems": problems}
    results = [obj for obj in bpy.data.objects if f"object {obj.name_full} role" not in before]
    problems += _result_problems(results, scene) + _changes(before, after, results, scene)
    if seconds < PATIENCE and not problems:
        problems += _again(scene, before, after, results)
    problems += _cleared(before)
    return {"name": scene.name, "refusal": "", "problems": problems}


def _called(operator: str, seconds: float = SECONDS, **options) -> str:
    """Nothing where the operator finished within `seconds` of processor time, or what it said."""
    try:
        with at_most(seconds):
            ended = getattr(bpy.ops.reflection_mesh, operator)("EXEC_DEFAULT", **options)
    except RuntimeError as error:
        # Blender turns what an operator raises into its own error
        return f"time: more than {seconds:g} s" if "TooLong" in str(error) else str(error).strip()
    except TooLong:
        return f"time: more than {seconds:g} s"
    return "" if ended == {"FINISHED"} else f"ended with {sorted(ended)} and no sentence"


def _refusal_problems(outcome: str) -> list[str]:
    if outcome.startswith("time:"):
        return [outcome]
    if "Traceback" in outcome:
        lines = [line.strip() for line in outcome.splitlines() if line.strip()]
        places = [line for line in lines if line.startswith("File ")]
        errors = [line for line in lines if re.match(r"\w*(Error|Warning|Exception)", line)]
        return [f"error: {errors[-1] if errors else lines[-1]} ({places[-1] if places else ''})"]
    if re.search(r"\w(Error|Exception|Warning)\b", outcome):
        return [f"error: {outcome}"]
    return [] if SENTENCE.fullmatch(outcome) else [f"refusal: not one sentence: {outcome!r}"]


def _result_problems(results: list, scene: Scene) -> list[str]:
    found = [] if results else ["result: finished without one"]
    for obj in results:
        found += [f"result: '{obj.name}': {problem}" for problem in result_problems(obj)]
        if scene.options["method"] == "POINTS":
            found += [f"result: '{obj.name}': {problem}" for problem in disc_problems(obj)]
    return found


def _changes(before: dict, after: dict, results: list, scene: Scene) -> list[str]:
    """What changed beside the results: their objects and meshes are new, they are selected, and one is active."""
    expected = dict(before)
    new = {"objects": [obj.name_full for obj in results], "meshes": [obj.data.name_full for obj in results]}
    if scene.options["method"] == "POINTS":
        new["node_groups"] = [group.name_full for group in bpy.data.node_groups
                              if group.name_full not in before["data node_groups"]]
        if len(new["node_groups"]) != len(results):
            return [f"changed: {len(new['node_groups'])} groups of nodes for {len(results)} results"]
    for kind, names in new.items():
        expected[f"data {kind}"] = sorted(before[f"data {kind}"] + names)
    if after["active"] not in new["objects"]:
        return [f"changed: the active object is {after['active']!r}"]
    expected["active"] = after["active"]
    if scene.options["placement"] == "VIRTUAL":
        for mirror in scene.mirrors:
            for name in (f"object {mirror.name_full} visible_camera", f"object {mirror.name_full} role"):
                expected[name] = after[name]
    return [f"changed: {one}" for one in differences(expected, after)]


def _again(scene: Scene, before: dict, after: dict, results: list) -> list[str]:
    """A second run as the first updates the results in place, to the same."""
    made, names = [digest(obj.data) for obj in results], [obj.name_full for obj in results]
    chosen = [obj for obj in bpy.context.view_layer.objects if before.get(f"object {obj.name_full} selected")]
    select(chosen, bpy.data.objects.get(before["active"] or ""))
    outcome = _called("generate", **scene.options)
    if outcome:
        return [f"again: {outcome}"]
    # the nodes of points are made anew
    found = [f"again: {one}" for one in differences(without(after, "active", "selected", "node_groups"), state())]
    if len(bpy.data.node_groups) != len(after["data node_groups"]):
        found.append(f"again: {len(bpy.data.node_groups)} groups of nodes, not {len(after['data node_groups'])}")
    if [obj.name_full for obj in results] != names or [digest(obj.data) for obj in results] != made:
        found.append("again: the results are others")
    return found


def _cleared(before: dict) -> list[str]:
    """Clearing leaves the file as it was, but for the selection."""
    select([], bpy.context.view_layer.objects.active)
    outcome = _called("clear")
    if outcome:
        return [f"clear: {outcome}"]
    return [f"clear: {one}" for one in differences(without(before, "active", "selected"), state())]
