"""Blender's own tree as a rival: against the float64 ray tracer, and against NumPy's rays for the same blocks."""
import numpy as np
import pytest

from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare_picture
from tests.oracles.truth import trace

PIXELS = 48


@pytest.mark.parametrize("name", ["sphere", "flat_ortho", "bowl", "sphere_far"])
def test_its_rays_show_the_truth(room, name):
    rival, rivals = room("addon.benchmark.rival_bvhtree").RIVAL, room("core.rivals")
    case = SCENES[name]((PIXELS, PIXELS))
    truth = trace(case.view, case.mirror, case.scene)
    hits = rivals.primary_hits(case.view, case.mirror, case.scene)
    picture = rival.run(case.view, case.mirror, case.scene, 1, hits)
    numbers = compare_picture(case.view, truth, picture.triangle, picture.position).numbers
    # single precision may name the triangle beside an edge: as far off as the edge is from the pixel's centre
    assert numbers["maximum"] < 0.01 and numbers["uncovered"] < 0.05 and numbers["compared"] > 200
    judged = (truth.mirror_triangle >= 0) & ~truth.bent
    itself = picture.triangle.ravel() == rivals.ITSELF
    assert (itself != truth.sees_itself)[judged].mean() < 0.001
    assert picture.counts["rays"] == picture.counts["traversals"] >= len(hits.pixel)


def test_blocks_of_pixels_are_those_of_the_other_ray_tracer(room):
    rival, rivals = room("addon.benchmark.rival_bvhtree").RIVAL, room("core.rivals")
    case = SCENES["sphere"]((PIXELS, PIXELS))
    hits = rivals.primary_hits(case.view, case.mirror, case.scene)
    own, other = (method.run(case.view, case.mirror, case.scene, 4, hits) for method in (rival, rivals.METHODS["RAYS"]))
    same = own.triangle == other.triangle
    assert same.mean() > 0.999 and own.counts["rays"] == pytest.approx(other.counts["rays"], rel=0.01)
    assert np.abs(own.position - other.position)[same].max() < 1e-6
