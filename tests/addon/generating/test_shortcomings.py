"""What a result lacks is told, each cause in a sentence of its own that says what to do."""
import re
from types import SimpleNamespace

import parts
import pytest

COUNTS = ("crowded", "overlaid", "pierced", "many_outlines", "unfollowed", "bounded", "coarse")


@pytest.fixture(scope="module")
def told(room):
    def told(**counts):
        result = SimpleNamespace(counts=counts, missing_share=12.3, positions=range(50))
        return room("addon.operators.shortcomings").shortcomings("Lake", result)
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


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_what_a_render_blurs_otherwise_is_told(blank, capfd, placement):
    parts.select(parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror())

    def told() -> str:
        parts.generate(placement=placement)
        return "".join(capfd.readouterr())
    assert "blur" not in told()
    blank.scene.camera.data.dof.use_dof = blank.scene.render.use_motion_blur = True
    sentences = told()
    assert ("Depth of field: the camera focuses on the mirror" in sentences) == (placement == "LAYERED")
    assert "Motion blur: the reflection is that of one moment" in sentences
