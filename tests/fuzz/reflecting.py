"""One configuration reflected under watch: time, steps, memory, warnings, and how it was refused."""
from __future__ import annotations

import re
import time
import traceback
import warnings
from dataclasses import dataclass, field

from core import ReflectionError, ReflectionMesh, reflection_steps
from tests.fuzz.drawing.configurations import Configuration
from tests.fuzz.limits import TooLong, at_most, peak_gigabytes

SECONDS = 10.0  # of processor time, for one reflection of a few hundred triangles
STEP = 1.0  # seconds of processor time: twice what the window may stand still for, since machines differ
SLACK = 0.5  # gigabytes beyond the arrays that the settings allow
SENTENCE = re.compile(r"[A-Z][^.!?\n]*\.")


@dataclass
class Reflected:
    """What came of one configuration.

    Attributes
    ----------
    mesh : ReflectionMesh or None
    refusal : str
        The sentence with which it was refused; empty where it was not.
    problems : list of str
        What must not happen, each "what: how".
    seconds, longest : float
        Processor time of all and of the longest step.
    """

    mesh: ReflectionMesh | None = None
    refusal: str = ""
    problems: list[str] = field(default_factory=list)
    seconds: float = 0.0
    longest: float = 0.0


def reflected(configuration: Configuration) -> Reflected:
    """`core.reflect` of the configuration, and all that went wrong on the way."""
    done, peak, most = Reflected(), peak_gigabytes(), configuration.settings.maximum_memory + SLACK
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            with at_most(SECONDS, most):
                _run(configuration, done)
        except ReflectionError as error:
            done.refusal = str(error)
            if not SENTENCE.fullmatch(done.refusal):
                done.problems.append(f"refusal: not one sentence: {done.refusal!r}")
        except TooLong:
            done.problems.append(f"time: more than {SECONDS:g} s")
        except MemoryError:
            done.problems.append(f"memory: more than {most:g} GB")
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            done.problems.append(f"error: {type(error).__name__}: {error} ({place.filename}:{place.lineno})")
    done.problems += sorted({f"warning: {one.message} ({one.filename}:{one.lineno})" for one in heard})
    if peak_gigabytes() - peak > most:
        done.problems.append(f"memory: {peak_gigabytes() - peak:.1f} GB more than before")
    if done.longest > STEP and not any(one.startswith("time:") for one in done.problems):
        done.problems.append(f"step: {done.longest:.1f} s between two steps")
    return done


def _run(configuration: Configuration, done: Reflected) -> None:
    mirrors = configuration.mirrors if configuration.others is not None else None
    steps = reflection_steps(configuration.view, configuration.mirror, configuration.scene, configuration.settings,
                             mirrors)
    while True:
        before = time.process_time()
        try:
            next(steps)
        except StopIteration as end:
            done.mesh = end.value
        took = time.process_time() - before
        done.seconds, done.longest = done.seconds + took, max(done.longest, took)
        if done.mesh is not None:
            return
