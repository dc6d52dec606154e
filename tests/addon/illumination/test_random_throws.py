"""Light that mirrors drawn at random throw, beside what Cycles finds of it; and that the judge finds what is wrong."""
import bpy
import numpy as np
import pytest

from tests.fuzz.blender import thrown_trial
from tests.fuzz.blender.thrown_trial import tried_thrown
from tests.fuzz.kept import kept_seeds

SEEDS = (11, 27, 32, 35)  # metal, a mirror over paint, painted metal twice; `make fuzz` tries others


@pytest.mark.slow
@pytest.mark.parametrize("seed", kept_seeds("thrown"))
def test_kept_seeds(seed):
    assert tried_thrown(seed)["problems"] == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_mirrors_at_random(seed):
    tried = tried_thrown(seed)
    assert tried["problems"] == [] and not tried["refusal"] and "told" not in tried["name"], tried["name"]


@pytest.mark.slow
def test_what_is_wrong_is_found(monkeypatch):
    """After the light is made it is meddled with: half of it is missing, and something is left over."""
    called = thrown_trial.scene_trial._called

    def meddling(operator, *arguments, **options):
        outcome = called(operator, *arguments, **options)
        if operator == "caustics":
            for name in ("caustic_light", "mirror_light_0"):
                attribute = bpy.data.objects["Mirror Caustics"].data.attributes[name]
                values = np.empty(3 * len(attribute.data), dtype=np.float32)
                attribute.data.foreach_get("vector", values)
                attribute.data.foreach_set("vector", values * np.float32(0.5))
            bpy.data.materials.new("Left over")
        return outcome
    monkeypatch.setattr(thrown_trial.scene_trial, "_called", meddling)
    found = "\n".join(tried_thrown(SEEDS[-1])["problems"])
    assert "thrown: " in found and "clear: data materials" in found
