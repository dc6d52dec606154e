"""The operators on scenes drawn at random, and the checks of these themselves: each finds the fault it is there for."""
import bpy
import numpy as np
import parts
import pytest

from tests.fuzz.blender import scene_trial
from tests.fuzz.blender.scene_checks import result_problems
from tests.fuzz.blender.scene_state import differences, state
from tests.fuzz.blender.scene_trial import tried_scene
from tests.fuzz.kept import kept_seeds

SEEDS = range(60)  # `make fuzz` tries others


@pytest.mark.slow
@pytest.mark.parametrize("seed", kept_seeds("scenes"))
def test_kept_seeds(seed):
    assert tried_scene(seed)["problems"] == []


@pytest.mark.thorough
@pytest.mark.parametrize("seed", SEEDS)
def test_scenes_at_random(seed):
    assert tried_scene(seed)["problems"] == []


@pytest.fixture
def result(blank):
    """A good result: a triangle in a wall mirror."""
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    mirror = parts.add_wall_mirror()
    parts.select(leaf, mirror)
    made = parts.generate()
    assert list(result_problems(made)) == []
    return made


def _attribute(name, value):
    def change(obj):
        values = parts.attribute(obj, name)
        values[0] = value
        obj.data.attributes[name].data.foreach_set("vector" if values.ndim > 1 else "value", values.ravel())
    return change


def _twice(obj):
    corners = parts.corners(obj)
    obj.data.attributes[".corner_vert"].data.foreach_set("value", corners[:, [0, 0, 2]].ravel())


FAULTS = {
    "position": (_attribute("position", (np.nan, 0.0, 0.0)), "position holds"),
    "reflected_position": (_attribute("reflected_position", (np.inf, 0.0, 0.0)), "reflected_position holds"),
    "path_length": (_attribute("path_length", -1.0), "path_length reaches"),
    "image_parity": (_attribute("image_parity", 2), "image_parity reaches"),
    "source_object": (_attribute("source_object", 1), "source_object reaches"),
    "mirror_face": (_attribute("mirror_face", -2), "mirror_face reaches"),
    "material_index": (_attribute("material_index", 5), "Blender mends"),
    "corners": (_twice, "Blender mends"),
    "attributes": (lambda obj: obj.data.attributes.remove(obj.data.attributes["source_face"]), "it has no source_face"),
    "error": (lambda obj: setattr(obj.reflection_mesh, "estimated_error", np.nan), "its estimated error"),
    "role": (lambda obj: setattr(obj.reflection_mesh, "role", "AUTO"), "an object that is no reflection"),
    "geometry": (lambda obj: obj.data.clear_geometry(), "it shows nothing"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_of_a_result_is_found(result, fault):
    change, found = FAULTS[fault]
    change(result)
    assert [problem for problem in result_problems(result) if problem.startswith(found)]


CHANGES = {
    "place": lambda: setattr(bpy.data.objects["Leaf"], "delta_location", (0.0, 0.0, 1e-3)),
    "visibility": lambda: setattr(bpy.data.objects["Leaf"], "hide_render", True),
    "rays": lambda: setattr(bpy.data.objects["Mirror"], "visible_glossy", False),
    "selection": lambda: bpy.data.objects["Leaf"].select_set(False),
    "active": lambda: setattr(bpy.context.view_layer.objects, "active", bpy.data.objects["Leaf"]),
    "data": lambda: bpy.data.meshes.new("Left over"),
    "name": lambda: setattr(bpy.data.objects["Leaf"], "name", "Leaf.001"),
    "vertex": lambda: setattr(bpy.data.objects["Leaf"].data.vertices[0], "co", (0.0, 0.0, 0.0)),
    "layer": lambda: bpy.data.objects["Leaf"].data.uv_layers.new(name="New"),
    "material": lambda: bpy.data.objects["Leaf"].data.materials.append(bpy.data.materials.new("New")),
    "modifier": lambda: bpy.data.objects["Leaf"].modifiers.new("New", "TRIANGULATE"),
    "role": lambda: setattr(bpy.data.objects["Leaf"].reflection_mesh, "role", "IGNORE"),
    "camera": lambda: setattr(bpy.context.scene, "camera", None),
    "render": lambda: setattr(bpy.context.scene.render, "resolution_percentage", 50),
    "frame": lambda: bpy.context.scene.frame_set(7),
    "settings": lambda: setattr(bpy.context.scene.reflection_mesh, "tolerance", 0.25),
}


@pytest.mark.thorough
@pytest.mark.parametrize("change", CHANGES)
def test_each_change_of_the_file_is_found(result, change):
    before = state()
    assert differences(before, state()) == []
    CHANGES[change]()
    bpy.context.view_layer.update()
    assert differences(before, state())


@pytest.fixture(scope="module")
def shown():
    """A seed whose scene gives a result."""
    return next(seed for seed in SEEDS if not any(tried_scene(seed)[name] for name in ("refusal", "problems")))


@pytest.mark.parametrize("call", ["changed", "again", "clear"])
def test_what_an_operator_leaves_changed_is_found(monkeypatch, shown, call):
    """The first call generates, the second generates again, the third clears: one of them moves an object."""
    calls, called = [], scene_trial._called

    def meddling(operator, **options):
        outcome = called(operator, **options)
        calls.append(operator)
        if len(calls) == ["changed", "again", "clear"].index(call) + 1:
            bpy.data.objects["Object0"].delta_location.x += 1.0
            bpy.context.view_layer.update()
        return outcome
    monkeypatch.setattr(scene_trial, "_called", meddling)
    problems = tried_scene(shown)["problems"]
    assert calls[0] == "generate" and problems[0].startswith(f"{call}: object Object0 "), problems


@pytest.mark.parametrize(("outcome", "found"), [
    ("time: more than 20 s", "time:"), ("two\nlines.", "refusal:"), ("Error: no end", "refusal:"),
    ("Error: It failed (ValueError: odd).", "error:"),
    ('Error: Traceback\n  File "a.py", line 1\nValueError: odd', "error: ValueError: odd (File"),
    ("Error: The mirror has no faces.", "")])
def test_a_sentence_is_asked_for(monkeypatch, outcome, found):
    monkeypatch.setattr(scene_trial, "_called", lambda operator, **options: outcome)
    problems = tried_scene(0)["problems"]
    assert [problem for problem in problems if problem.startswith(found)] if found else problems == []
