"""Distinct integers and their order against NumPy's own."""
import numpy as np
import pytest

from core.geometry import distinct, first_of, in_order

RNG = np.random.default_rng(53)
KEYS = {
    "none": np.zeros(0, dtype=np.int64),
    "one": np.array([7]),
    "dense": RNG.integers(0, 50, 1000),
    "sparse": RNG.integers(0, 2**40, 1000) // 2**34 * 2**34,
    "too large to carry an index": RNG.integers(2**62, 2**63 - 1, 1000) // 2**54 * 2**54,
    "equal": np.full(300, 3),
    "small numbers of another kind": RNG.integers(0, 9, 500).astype(np.int8),
}


@pytest.mark.parametrize("name", KEYS)
def test_distinct_integers_are_numpys(name):
    key = KEYS[name]
    values, first, group = np.unique(key, return_index=True, return_inverse=True)
    for found, expected in ((distinct(key), (values, group)), (first_of(key), (values, first, group))):
        for own, other in zip(found, expected, strict=True):
            np.testing.assert_array_equal(own, other.reshape(-1))


@pytest.mark.parametrize("name", KEYS)
def test_equal_integers_stay_in_order(name):
    np.testing.assert_array_equal(in_order(KEYS[name]), np.argsort(KEYS[name], kind="stable"))
