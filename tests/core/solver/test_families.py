"""`core.project` against exact arithmetic on ten thousand pairs of every family: no disagreement that rounding does not
explain, and hardly any of the others where pairs are well-conditioned."""
import dataclasses

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core import Images, project
from tests.inputs.families import FAMILIES, pairs_of
from tests.oracles.exact_pairs import ExactPairs
from tests.oracles.explained import judge

pytestmark = pytest.mark.slow

# What rounding has to explain, in parts of the images, and a tenth more for other processors; in other families, and of
# vanishing cubics, nothing. Many of the points next to edges lie outside by less than rounding: those that are found
# there are many, so that it is held how far out they lie.
EXPLAINED = {
    "small integers": {"edge": 0.0087},
    "nearly planar, tilted": {"line": 0.0003, "touch": 0.0003},
    "double roots": {"edge": 0.0005},
    "triple roots": {"line": 0.0026},
    "near the caustic": {"line": 0.001, "edge": 0.0011, "touch": 0.07, "end": 0.0003},
    "next to edges": {"edge": 0.76},
    "eye almost on the mirror": {"edge": 0.0006},
    "rays through a line": {"edge": 0.012},
    "opposite rays but for rounding": {"line": 0.35, "edge": 0.0175},
    "point on a mirror edge but for rounding": {"line": 0.0033, "edge": 0.0285, "touch": 0.0007, "end": 0.262},
    "close to the mirror": {"end": 0.14},
    "nearly opposite rays": {"line": 0.049},
    "point between two corners": {"end": 0.047},
    "collision": {"line": 0.0081, "edge": 0.049, "end": 0.0161},
}

# in these the errors of places, in units of the condition times rounding, are 7 to 10.3, in others 1.9 at most
LARGE_ERRORS = {"opposite rays but for rounding", "point on a mirror edge but for rounding", "nearly opposite rays",
                "point between two corners", "close to the mirror"}


@pytest.mark.parametrize("name", FAMILIES)
def test_against_exact_arithmetic(name):
    vertices, rays, points = pairs_of(name)
    verdict = judge(vertices, rays, points)
    assert not verdict.unexplained
    share = {what: len(pairs) / max(verdict.images, 1) for what, pairs in verdict.explained.items()}
    assert all(share[what] <= EXPLAINED.get(name, {}).get(what, 0.0) for what in share), share
    # of how far rounding may bring an image out of a triangle, measured is 0.43 at most
    assert verdict.outside.max(initial=0.0) < 0.6
    # the stated bound is 60 units, and 6 for the root itself
    assert verdict.errors.max(initial=0.0) < (16.0 if name in LARGE_ERRORS else 3.0)


def test_what_rounding_cannot_be_blamed_for():
    """The judge itself: images taken away, added, moved or given the other parity do not pass."""
    vertices, rays, points = pairs_of("random", 500)
    images = project(vertices, rays, points)
    assert not judge(vertices, rays, points, images).unexplained
    keep = np.arange(len(images.pair)) != 7
    parts = images.pair, images.distance, images.weights, images.parity
    less = Images(*(part[keep] for part in parts), images.degenerate)
    assert judge(vertices, rays, points, less).unexplained["missed"].tolist() == [images.pair[7]]
    again = np.insert(np.arange(len(images.pair)), 7, 7)
    more = Images(*(part[again] for part in parts), images.degenerate)
    assert judge(vertices, rays, points, more).unexplained["found twice"].tolist() == [images.pair[7]]
    for change, complaint in ((1.0 + 1e-9, "not a root"), (1.0 + 2e-12, "missed")):
        moved = dataclasses.replace(images, distance=images.distance * change)
        assert len(judge(vertices, rays, points, moved).unexplained[complaint]) > 300
    moved = dataclasses.replace(images, weights=images.weights + [1e-9, -1e-9, 0.0])
    assert len(judge(vertices, rays, points, moved).unexplained["weights"]) > 400
    turned = dataclasses.replace(images, parity=-images.parity)
    assert len(judge(vertices, rays, points, turned).unexplained["parity"]) == len(images.pair)
    caustic = dataclasses.replace(images, parity=0 * images.parity)
    assert len(judge(vertices, rays, points, caustic).unexplained["parity 0 at a simple root"]) == len(images.pair)
    nothing = np.ones(500, dtype=bool)
    assert len(judge(vertices, rays, points, dataclasses.replace(images, degenerate=nothing)).unexplained[
        "flagged, not zero"]) == 500


def test_families_hold_what_they_are_called_after():
    def exact(name, n=300):
        pairs = ExactPairs(*pairs_of(name, n))
        return pairs, pairs.roots()

    for name, many in (("double roots", 2), ("triple roots", 3)):
        pairs, roots = exact(name)
        assert (roots.multiplicity == many).sum() > 200
    pairs, _ = exact("coplanar motion")
    assert (pairs.cubic == 0).all(axis=0).sum() == 240
    pairs, _ = exact("flat mirror, exact")
    c0, c1, c2, c3 = pairs.coefficients * np.outer(np.ones(4), 2.0 ** (3 * pairs.time_power)) / 2.0 ** np.outer(
        np.arange(4), pairs.time_power)
    assert (c0 - c1 + c2 - c3 == 0.0).all() and (c1 - 2.0 * c2 + 3.0 * c3 == 0.0).all()
    pairs, _ = exact("on the mirror")
    assert (pairs.cubic[0] == 0).all()
    pairs, _ = exact("collision", 3000)
    assert ((pairs.cubic[3] == 0) & (pairs.cubic[2] == 0)).mean() > 2 / 3
    assert 0.05 < (pairs.cubic == 0).all(axis=0).mean() < 0.5
    pairs, roots = exact("edges and vertices")
    weights = pairs.at(roots.cubic, roots.numerator, roots.shift).weights
    assert len(np.unique(roots.cubic[(weights == 0.0).any(axis=1) & (weights >= 0.0).all(axis=1)])) == 300


numbers = st.one_of(st.integers(-3, 3).map(float),
                    st.builds(lambda m, e: m * 10.0 ** e, st.floats(-1.0, 1.0, width=32), st.integers(-40, 40)))


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.lists(numbers, min_size=21, max_size=21))
# A root far out is as far from certain as the leading coefficient; the one at 2.7 is not.
@example([-2, -2, -3, 0, 0, 1, 0, -2, 0, 1, 0, 0, -1, 0, -2.0 ** -47, 1, -3, -1, 0, -2, -2])
def test_numbers_of_all_magnitudes(numbers):
    check(numbers)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.lists(st.integers(-3, 3), min_size=21, max_size=21))
def test_small_integers(numbers):
    """They meet every degenerate case that there is."""
    check(numbers)


def check(numbers):
    numbers = np.array(numbers, dtype=float)
    pair = numbers[None, :9].reshape(1, 3, 3), numbers[None, 9:18].reshape(1, 3, 3), numbers[None, 18:]
    assert not judge(*pair).unexplained
