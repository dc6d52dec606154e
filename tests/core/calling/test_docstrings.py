"""The examples in the docstrings of what the core hands out: there is one for each, and it shows what it says."""
import doctest
import sys

import pytest

import core

SHOWN = {name: getattr(core, name) for name in core.__all__ if callable(getattr(core, name))}


@pytest.mark.parametrize("name", SHOWN)
def test_a_public_name_has_an_example_in_its_own_docstring(name):
    assert doctest.DocTestParser().get_examples(SHOWN[name].__doc__)


@pytest.mark.parametrize("module", sorted({shown.__module__ for shown in SHOWN.values()}))
def test_the_examples_of_a_module_show_what_they_say(module):
    """Each imports all that it uses."""
    runner, told = doctest.DocTestRunner(), []
    for example in doctest.DocTestFinder(exclude_empty=True).find(sys.modules[module], globs={}):
        runner.run(example, out=told.append)
    assert runner.tries and not runner.failures, "".join(told)
