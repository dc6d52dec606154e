"""How much work each scene takes, counted: a change that does more, or less, says so here.

    python -m tests.core.reflection.test_counts

writes counts.json anew. Counts that follow from what is seen are held exactly; how tight bounding cones are, and
where refinement stops, depends on the last digits of sums, which NumPys and processors add in different orders. So
does whether a cell of filling holds the middle of its square: polygons are counted without cells, as "cut".
"""
import json
from pathlib import Path

import pytest

from core import reflect
from tests.inputs.dense_scenes import dense
from tests.inputs.scenes import SCENES
from tests.oracles.true_map import mesh_of

FILE = Path(__file__).with_name("counts.json")
PIXELS = 512
EXACT = ("mirror_triangles", "cameras", "candidates", "projections", "roots", "images", "cut", "joined",
         "caustic_edges")
NEARLY, SHARE = ("pairs", "occluded", "filled", "faces"), 0.01
DENSE, LONGEST = {"dense sphere": "sphere", "dense ortho": "sphere_ortho", "dense cylinder": "cylinder"}, 0.24
WHOLE = ("whole", "left", "hidden", "pieces", "cameras", "polygons", "faces")
"""Where whole faces end depends on the last digits too."""


def counted(name: str) -> dict[str, int]:
    if name in DENSE:
        case = dense(DENSE[name], (PIXELS, PIXELS), LONGEST)
        counts = reflect(case.view, case.mirror, case.scene).counts
        return {count: int(counts[count]) for count in WHOLE}
    counts = mesh_of(name, PIXELS).counts
    counts = counts | {"cut": counts["polygons"] - counts["filled"]}
    return {count: int(counts[count]) for count in EXACT + NEARLY}


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


if __name__ == "__main__":
    FILE.write_text(json.dumps({name: counted(name) for name in (*SCENES, *DENSE)}, indent=1) + "\n", encoding="utf-8")
