"""`core.reflect` on what failed once, and on small configurations drawn at random, each with twins of it."""
import pytest

from tests.fuzz.checks.picture_checks import regions
from tests.fuzz.checks.twins import TWINS
from tests.fuzz.drawing.configurations import drawn
from tests.fuzz.kept import kept_seeds
from tests.fuzz.kept_examples import EXAMPLES
from tests.fuzz.reflecting import reflected
from tests.fuzz.trying import problems_of

pytestmark = pytest.mark.slow

SEEDS = range(90)  # `make fuzz` tries others
WHOLE = 0.01  # of the mirror's pixels may be open where a result is to be whole


@pytest.mark.parametrize("name", EXAMPLES)
def test_what_failed_once(name):
    assert problems_of(EXAMPLES[name], 1, tuple(TWINS)) == []


@pytest.mark.parametrize("name", [name for name in EXAMPLES if "parallel eye" in name])
def test_a_parallel_eye_sees_a_closed_mirror_whole(name):
    """Whether the result tells of what it misses or not."""
    seen, wrong = regions(EXAMPLES[name], reflected(EXAMPLES[name]).mesh)
    assert seen > 400 and wrong["holes"] <= WHOLE * seen


@pytest.mark.parametrize("seed", kept_seeds("core"))
def test_kept_seeds(seed):
    assert problems_of(drawn(seed), seed) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_configurations_at_random(seed):
    assert problems_of(drawn(seed), seed) == []
