"""Light on reflections of scenes drawn at random, judged by Cycles; and that the judge finds what it is there for."""
import bpy
import numpy as np
import pytest

from tests.fuzz.blender import lit_trial
from tests.fuzz.blender.lit_trial import tried_lit
from tests.fuzz.kept import kept_seeds

SEEDS = (11, 46)  # light of the picture, and on the objects; `make fuzz` tries others


@pytest.mark.parametrize("seed", kept_seeds("lit"))
def test_kept_seeds(seed):
    assert tried_lit(seed)["problems"] == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_lit_scenes_at_random(seed):
    tried = tried_lit(seed)
    assert tried["problems"] == [] and not tried["refusal"], tried["name"]


@pytest.mark.slow
def test_what_is_wrong_is_found(monkeypatch):
    """After lighting the file is meddled with: the light is half of what it was, and something is left over."""
    called = lit_trial.scene_trial._called

    def meddling(operator, *arguments, **options):
        outcome = called(operator, *arguments, **options)
        if operator == "light":
            light = next(image for image in bpy.data.images if image.name == "Reflection Light")
            light.pixels.foreach_set(0.5 * np.array(light.pixels[:], dtype=np.float32))
            bpy.data.materials.new("Left over")
        return outcome
    monkeypatch.setattr(lit_trial.scene_trial, "_called", meddling)
    found = "\n".join(tried_lit(SEEDS[1])["problems"])
    assert "light: " in found and "clear: data materials" in found and "Left over" in found
