"""Work in steps: it hands over often, ends when it is stopped, and errors come to the caller."""
import threading
import time

import numpy as np
import pytest

from core import Settings, reflect, reflection_steps
from core.support.stepping import INTERVAL, breathe, in_steps, tell
from tests.core.filling.test_filling import VIEW, soup
from tests.oracles.true_map import case_of

pytestmark = pytest.mark.slow


def told_and_result(steps):
    told = []
    while True:
        try:
            told.append(next(steps))
        except StopIteration as end:
            return told, end.value


def work_of(seconds, seen):
    tell(0.25, "first")
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        breathe()
        seen.append(time.perf_counter())
    tell(0.75, "second")
    return "done"


def test_long_work_hands_over_several_times_a_second_and_returns_its_result():
    told, result = told_and_result(in_steps(lambda: work_of(8 * INTERVAL, [])))
    assert result == "done"
    assert told[0] == (0.25, "first") and told[-1] == (0.75, "second")
    assert 4 <= told.count((0.25, "first")) <= 10


def test_work_rests_while_the_caller_has_its_turn():
    seen = []
    steps = in_steps(lambda: work_of(10.0, seen))
    next(steps), next(steps)
    count = len(seen)
    time.sleep(3 * INTERVAL)
    assert len(seen) == count
    steps.close()


def test_closing_the_steps_ends_the_work_at_once():
    before, seen = threading.active_count(), []
    steps = in_steps(lambda: work_of(60.0, seen))
    next(steps), next(steps)
    started = time.perf_counter()
    steps.close()
    assert time.perf_counter() - started < 1.0
    assert threading.active_count() == before
    count = len(seen)
    time.sleep(INTERVAL)
    assert len(seen) == count


def test_an_error_of_the_work_is_raised_where_its_steps_are_asked_for():
    def work():
        tell(0.5, "before")
        raise ValueError("wrong")
    steps = in_steps(work)
    assert next(steps) == (0.5, "before")
    with pytest.raises(ValueError, match="wrong"):
        next(steps)
    assert list(steps) == []


def test_steps_that_are_never_begun_do_nothing():
    begun = []
    in_steps(lambda: begun.append(1)).close()
    assert begun == []


def test_outside_of_steps_breathing_and_telling_do_nothing():
    breathe()
    tell(0.5, "nobody listens")


def test_the_same_result_in_steps_and_at_once():
    case = case_of("bowl")
    told, mesh = told_and_result(reflection_steps(case.view, case.mirror, case.scene))
    at_once = reflect(case.view, case.mirror, case.scene)
    for name in ("positions", "triangles", "reflected_position", "source_weights"):
        np.testing.assert_array_equal(getattr(mesh, name), getattr(at_once, name))
    shares = [share for share, _ in told]
    assert shares == sorted(shares) and 0.0 <= shares[0] and shares[-1] <= 1.0


def test_no_step_is_long_even_where_mirrors_cross_each_other():
    mirror, scene = soup(250, 3), soup(60, 8)
    steps = reflection_steps(VIEW, mirror, scene, Settings(depth=2))
    longest, last = 0.0, time.process_time()
    for _ in steps:
        now = time.process_time()
        longest, last = max(longest, now - last), now
    # 0.5 s are allowed on an idle machine; tests may share theirs
    assert longest < 1.0
