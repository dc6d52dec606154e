"""One configuration tried: reflected, checked, and compared with two of its twins."""
from __future__ import annotations

import numpy as np

from core import ReflectionMesh
from tests.fuzz.checks import mesh_checks, picture_checks, place_checks
from tests.fuzz.checks.twins import TWINS, nearly_the_same, same_to_the_bit
from tests.fuzz.drawing.configurations import Configuration
from tests.fuzz.reflecting import Reflected, reflected

CHECKS = mesh_checks.THEN + place_checks.CHECKS + picture_checks.CHECKS
PATIENCE = 1.0  # seconds: what takes longer is not done again for its twins


def problems_of(configuration: Configuration, seed: int = 0, twins: tuple[str, ...] = ()) -> list[str]:
    """All that is wrong with what `core.reflect` makes of a configuration, each "what: how".

    Parameters
    ----------
    seed : int
        Draws what differs in the twins.
    twins : tuple of str
        Names of `TWINS`; where omitted, that in another order and one more, by the seed.
    """
    done = reflected(configuration)
    problems = list(done.problems)
    if done.mesh is not None:
        problems += checked(configuration, done.mesh)
    problems += picture_checks.refused_rightly(configuration, done.refusal)
    if done.mesh is None and not done.refusal or done.seconds > PATIENCE:
        return problems
    others = [name for name in TWINS if name != "in another order"]
    for name in twins or ("in another order", others[seed % len(others)]):
        problems += twin_problems(configuration, done, name, np.random.default_rng((seed, 1)))
    return problems


def checked(configuration: Configuration, mesh: ReflectionMesh) -> list[str]:
    """What does not hold in one mesh; no more than numbers and indices where those are none."""
    first = [problem for check in mesh_checks.FIRST for problem in check(configuration, mesh)]
    return first or [problem for check in CHECKS for problem in check(configuration, mesh)]


def twin_problems(configuration: Configuration, done: Reflected, name: str, rng: np.random.Generator) -> list[str]:
    """How the reflection of a twin differs; a twin that is refused must be refused as the configuration was."""
    twin = TWINS[name](rng, configuration)
    other = reflected(twin.configuration)
    problems = [problem for problem in other.problems if problem not in done.problems]
    if other.mesh is not None and done.mesh is not None:
        problems += same_to_the_bit(done.mesh, other.mesh, twin.factor, configuration, twin.configuration) \
            if twin.factor is not None \
            else nearly_the_same(done.mesh, other.mesh, configuration, twin.configuration, twin.share)
    elif other.refusal != done.refusal:
        problems.append(f"refused with {other.refusal!r}, not {done.refusal!r}")
    return [f"twin: {name}: {problem}" for problem in problems]
