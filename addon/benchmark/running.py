"""Runs a method at the values of its knob, as far as its time goes, and judges each."""
from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from ...core import ReflectionError
from ...core.rivals import PrimaryHits
from ..report import LEAST, Run, pareto
from .case import Case
from .judging import Sampled, errors
from .methods import Method
from .truth import Truths

SHORT, REPEATS = 0.5, 2     # runs shorter than SHORT seconds are repeated up to REPEATS times; the fastest counts


@dataclass(frozen=True)
class Contest:
    """The common input of all methods: a case, the visible points of its mirror (precomputed for all), and the ground
    truth.
    """

    case: Case
    hits: PrimaryHits
    truths: Truths


def run_method(contest: Contest, key: str, method: Method, budget: float) -> tuple[list[Run], list[str]]:
    """Return the runs of one method, and sentences on the values that were left out.

    Parameters
    ----------
    budget : float
        Seconds: a value that is expected to take longer is left out, and with it all finer ones.
    """
    runs, expected = [], 0.0
    for index, value in enumerate(method.values):
        left = ", ".join(f"{other:g}" for other in method.values[index:])
        if expected > budget:
            return runs, [f"{method.title}: {method.knob} {left} left out: about {expected:.1f} s were expected, and "
                          f"{budget:g} s are allowed."]
        try:
            made, seconds, cpu, took = _quickest(contest, method, value)
        except (ReflectionError, MemoryError) as error:
            reason = str(error).rstrip(".") or "the memory does not suffice"
            return runs, [f"{method.title}: {method.knob} {left} left out: {reason}."]
        # processor time does not depend on other work on the machine
        expected = method.growth * min(took, cpu)
        numbers = errors(contest.case, [contest.truths.centres], made)
        numbers["area"] = errors(contest.case, contest.truths.area, made)
        numbers["cpu_seconds"] = cpu
        if made.picture.mesh is not None:
            numbers["seconds_without_drawing"] = sum(
                spent_on for stage, spent_on in seconds.items() if stage not in ("drawing", "picture"))
        counts = {name: count for name, count in made.picture.counts.items() if count}
        runs.append(Run(key, method.title, method.knob, float(value), seconds, counts, numbers))
    return runs, []


def with_fronts(runs: list[Run]) -> tuple[Run, ...]:
    """Return the runs, each marked if it is on the Pareto front of run time and mean error, in both measures. Errors
    below `LEAST` are equal.
    """
    for name, numbers in (("centres", lambda run: run.numbers), ("area", lambda run: run.numbers["area"])):
        best = pareto(np.array([run.total for run in runs]),
                      np.array([max(numbers(run)["mean_error_px"], LEAST) for run in runs])) if runs else []
        for run, good in zip(runs, best):
            run.numbers.setdefault("on_front", {})[name] = bool(good)
    return tuple(runs)


def _quickest(contest: Contest, method: Method, value: float) -> tuple[Sampled, dict, float, float]:
    """Return the output for a value, its run times by stage and processor time in the fastest run, and the duration of
    the first run.
    """
    best, first = None, 0.0
    for _ in range(REPEATS):
        started, processor = time.perf_counter(), time.process_time()
        made = method.run(contest.case, value, contest.hits)
        took, processor = time.perf_counter() - started, time.process_time() - processor
        first = first or took
        seconds = made.picture.seconds
        if best is None or sum(seconds.values()) < sum(best[1].values()):
            best = made, {stage: float(spent) for stage, spent in seconds.items()}, processor
        if took > SHORT:
            break
    return *best, first
