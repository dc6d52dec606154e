"""Counted work of each scene. A change that alters it must change counts.json too.

`python -m tools.counts` shows what differs. Counts that follow from what is seen are held exactly; how tight bounding
cones are, and where refinement stops, depends on the last digits of sums, which NumPys and processors add in different
orders. So does whether a cell of filling holds the middle of its square: polygons are counted without cells, as "cut".
"""
import json

import pytest

from tests.inputs.scenes import SCENES
from tools.counts import DENSE, EXACT, FILE, NEARLY, counted

SHARE = 0.01


@pytest.mark.parametrize("name", SCENES)
def test_the_work_is_what_it_was(name):
    held, found = json.loads(FILE.read_text(encoding="utf-8"))[name], counted(name)
    assert {count: found[count] for count in EXACT} == {count: held[count] for count in EXACT}
    for count in NEARLY:
        assert found[count] == pytest.approx(held[count], rel=SHARE, abs=2)


@pytest.mark.slow
@pytest.mark.parametrize("name", DENSE)
def test_as_many_faces_are_whole_as_were(name):
    held, found = json.loads(FILE.read_text(encoding="utf-8"))[name], counted(name)
    assert found == pytest.approx(held, rel=SHARE, abs=2)


def test_no_scene_is_without_counts():
    assert set(json.loads(FILE.read_text(encoding="utf-8"))) == {*SCENES, *DENSE}
