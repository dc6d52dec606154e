"""What a result lacks is told, each cause in a sentence of its own that says what to do."""
import re
from types import SimpleNamespace

import pytest

COUNTS = ("crowded", "overlaid", "pierced", "many_outlines", "unfollowed", "bounded", "coarse")


@pytest.fixture(scope="module")
def told(room):
    def told(**counts):
        result = SimpleNamespace(counts=counts, missing_share=12.3, positions=range(50))
        return room("addon.shortcomings").shortcomings("Lake", result)
    return told


@pytest.mark.parametrize("count", COUNTS)
def test_each_count_has_a_sentence(told, count):
    (sentence,) = told(**{count: 7})
    assert re.fullmatch(r"Lake: [A-Z0-9][^.]+: [a-z][^.]+\.", sentence)
    assert "7" in sentence or count == "bounded"


def test_sentences_differ_and_a_good_result_has_none(told):
    assert len({one for count in COUNTS for one in told(**{count: 1})}) == len(COUNTS)
    assert told(**dict.fromkeys(COUNTS, 0), missed=0) == []
    assert told(missed=2) == [] and "About 12 %" in told(missed=3)[0]
