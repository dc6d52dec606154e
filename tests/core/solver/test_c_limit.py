"""The C that the method's kernels are timed against does the same."""
import numpy as np
import pytest

from tools.solver.c_limit import Missing, agreement, compiled, kernels


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    try:
        return compiled(tmp_path_factory.mktemp("c"))
    except Missing as missing:
        pytest.skip(str(missing))


@pytest.mark.thorough
def test_kernels_in_c_give_the_same_to_rounding(library):
    for kernel in kernels(library, 20_000):
        differing, away = agreement(kernel)
        assert differing < 1e-4 and away < 1e-9, kernel.name
        found = kernel.numpy()
        assert np.isfinite(found).all() and (np.abs(found) < 1e99).mean() > 0.1


def test_without_a_compiler_it_says_so_in_one_sentence(monkeypatch, tmp_path):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(Missing, match=r"^There is no C compiler; [^.]*\."):
        compiled(tmp_path)
