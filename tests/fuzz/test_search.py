"""The search itself: what goes wrong on the way is told, work is stopped, seeds are kept, workers are started again."""
import signal
import warnings

import numpy as np
import pytest

from core import ReflectionError
from tests.fuzz import limits, reflecting
from tests.fuzz.asking import Asked
from tests.fuzz.drawing.configurations import drawn
from tests.fuzz.kept import OF_A_KIND, keep, kept_seeds
from tests.fuzz.limits import at_most
from tests.fuzz.reflecting import reflected

pytestmark = pytest.mark.slow

SEEN = 11  # a configuration of which nothing is wrong


def _warned():
    warnings.warn("something odd", RuntimeWarning, stacklevel=1)
    yield 0.0, ""


def _slow():
    while True:
        pass
    yield


def _refused(sentence):
    def steps():
        raise ReflectionError(sentence)
        yield
    return steps


def _broken():
    raise IndexError("out of bounds")
    yield


def _greedy():
    yield np.ones(10**9)


@pytest.mark.parametrize(("steps", "found"), [
    (_warned, "warning: something odd"), (_slow, "time:"), (_refused("two. Sentences."), "refusal:"),
    (_refused("The mirror is bad"), "refusal:"), (_broken, "error: IndexError"), (_greedy, "memory:")])
def test_each_fault_of_the_way_is_found(monkeypatch, steps, found):
    monkeypatch.setattr(reflecting, "reflection_steps", lambda *arguments: steps())
    monkeypatch.setattr(reflecting, "SECONDS", 0.1)
    assert [problem for problem in reflected(drawn(SEEN)).problems if problem.startswith(found)]


def test_a_long_step_is_found(monkeypatch):
    monkeypatch.setattr(reflecting, "STEP", 0.0)
    assert reflected(drawn(SEEN)).problems[0].startswith("step:")


def test_work_that_swallows_the_limit_is_stopped_all_the_same(monkeypatch):
    monkeypatch.setattr(limits, "AGAIN", 0.1)
    with pytest.raises(limits.TooLong), at_most(0.1):
        try:
            while True:
                pass
        except limits.TooLong:
            while True:
                pass


def test_limits_are_taken_back():
    with pytest.raises(MemoryError), at_most(5.0, 0.05):
        np.empty(10**9)  # more than what was freed before could hold
    assert np.ones(10**7).sum() == 1e7


def test_a_seed_gives_one_configuration():
    one, again, other = drawn(7), drawn(7), drawn(8)
    assert one.name == again.name != other.name
    np.testing.assert_array_equal(one.mirror.positions, again.mirror.positions)
    np.testing.assert_array_equal(one.scene.positions, again.scene.positions)
    np.testing.assert_array_equal(one.view.camera_to_world, again.view.camera_to_world)


def test_seeds_that_fail_are_kept_but_not_many_alike(tmp_path):
    file = tmp_path / "kept.json"
    assert kept_seeds("core", file) == []
    for seed in range(2 * OF_A_KIND):
        assert keep("core", seed, f"source: {seed} points", file) == (seed < OF_A_KIND)
    assert keep("core", 50, "twin: moved: 3 pixels", file) and keep("core", 51, "twin: turned: 3 pixels", file)
    assert keep("scenes", 50, "crash: SIGSEGV", file) and not keep("scenes", 50, "time: 3 s", file)
    assert kept_seeds("core", file) == [*range(OF_A_KIND), 50, 51] and kept_seeds("scenes", file) == [50]


def test_a_worker_that_ends_is_told_and_started_again():
    asked = Asked("core")
    try:
        assert asked.about(SEEN) == {"seed": SEEN, "name": drawn(SEEN).name, "problems": []}
        asked._worker.send_signal(signal.SIGSEGV)
        asked._worker.wait()
        assert asked.about(SEEN)["problems"] == ["crash: SIGSEGV"]
        assert asked.about(SEEN)["problems"] == []
    finally:
        asked.close()
