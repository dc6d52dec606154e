"""Caustics of lamps drawn at random in scenes drawn at random; and that the checks find what they are there for."""
import bpy
import pytest

from tests.fuzz.blender import scene_light_trial, scene_trial
from tests.fuzz.blender.scene_light_trial import tried_lamps
from tests.fuzz.kept import kept_seeds

SEEDS = range(16)  # `make fuzz` tries others


@pytest.mark.slow
@pytest.mark.parametrize("seed", kept_seeds("lamps"))
def test_kept_seeds(seed):
    assert tried_lamps(seed)["problems"] == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_lamps_at_random(seed):
    assert tried_lamps(seed)["problems"] == []


@pytest.fixture(scope="module")
def shown():
    """A seed whose lamps throw light."""
    return next(seed for seed in range(40) if not any(tried_lamps(seed)[name] for name in ("refusal", "problems")))


@pytest.mark.thorough
@pytest.mark.parametrize(("call", "found"), [(0, "changed: object"), (1, "again: object"), (2, "clear: object")])
def test_what_an_operator_leaves_changed_is_found(monkeypatch, shown, call, found):
    calls, called = [], scene_trial._called

    def meddling(operator, *arguments, **options):
        outcome = called(operator, *arguments, **options)
        calls.append(operator)
        if len(calls) == call + 1:
            bpy.data.objects["Mirror0"].delta_location.x += 1.0
            bpy.context.view_layer.update()
        return outcome
    monkeypatch.setattr(scene_light_trial.scene_trial, "_called", meddling)
    problems = tried_lamps(shown)["problems"]
    assert calls[0] == "caustics" and problems[0].startswith(found), problems


def test_a_material_that_is_not_ours_is_found(monkeypatch, shown):
    called = scene_trial._called

    def meddling(operator, *arguments, **options):
        outcome = called(operator, *arguments, **options)
        bpy.data.materials.new("Left over")
        return outcome
    monkeypatch.setattr(scene_light_trial.scene_trial, "_called", meddling)
    assert any("Left over" in problem for problem in tried_lamps(shown)["problems"])
