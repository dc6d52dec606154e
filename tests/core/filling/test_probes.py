"""Probes: a result from which whole regions are missing says so, and no other does."""
import tracemalloc

import numpy as np
import pytest

import core.cameras.three_ray_cameras
from core import Settings, TriangleMesh, View, reflect
from core.cameras.mirror_map import MirrorMap
from core.culling.scene_and_mirrors import SceneAndMirrors
from core.filling import probes
from core.filling.probes import missed_probes
from core.geometry.canonical_order import ordered
from core.trees.scene_tree import SceneTree
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.true_map import case_of


@pytest.mark.thorough
@pytest.mark.parametrize("name", SCENES)
def test_whole_results_miss_nothing(name):
    case = case_of(name)
    mesh = reflect(case.view, case.mirror, case.scene)
    assert mesh.counts["probes"] > 10
    assert mesh.counts["missed"] <= 1 and mesh.missing_share < 3.0


def test_the_share_of_what_is_missing_is_told():
    case = case_of("flat")
    mirror = ordered(case.mirror, shading=True)[0]
    met = SceneAndMirrors(SceneTree.build(case.scene), mirror)
    mesh = reflect(case.view, case.mirror, case.scene)
    pixels = case.view.pixels(mesh.mirror_position)[mesh.triangles]
    middle = np.median(pixels[..., 0])

    def missed(kept):
        return missed_probes(case.view, mirror, MirrorMap(case.view, mirror), met, mesh.mirror_position,
                             mesh.triangles[kept])
    probes, none = missed(np.ones(len(pixels), dtype=bool))
    assert none == 0
    assert missed(np.zeros(len(pixels), dtype=bool)) == (probes, probes)
    left = pixels[..., 0].max(axis=1) < middle
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    assert missed(left)[1] / probes == pytest.approx(1.0 - area[left].sum() / area.sum(), abs=0.12)


def test_a_mirror_of_which_half_the_triangles_are_taken_for_hidden_is_found_out(monkeypatch):
    view = View.looking_at((0.0, -5.0, 1.0), (0.0, 0.0, 0.5), (160, 120))
    mirror = shapes.combine(shapes.icosphere((0.0, 0.0, 0.5), 1.0, 3))
    scene = shapes.combine(shapes.quad((0.0, 0.0, -1.0), (9.0, 0.0, 0.0), (0.0, 9.0, 0.0)))
    assert reflect(view, mirror, scene).missing_share == 0.0
    whole = core.cameras.visible_triangles
    monkeypatch.setattr("core.reflection.visible_triangles", lambda *given: whole(*given)[::2])
    # a face near enough counts as one that covers: triangles are a few pixels wide at the outline
    assert reflect(view, mirror, scene).missing_share > 5.0


def test_nothing_is_probed_where_the_mirror_shows_nothing():
    view = View.looking_at((0.0, -5.0, 1.0), (0.0, 0.0, 0.5), (64, 64))
    mirror = shapes.combine(shapes.quad((0.0, 1.0, 0.5), (1.5, 0.2, 0.0), (0.0, 0.0, 1.2)))
    behind = TriangleMesh([[0.0, 4.0, 0.0], [1.0, 4.0, 0.0], [0.0, 4.0, 1.0]], [[0, 1, 2]])
    mesh = reflect(view, mirror, behind, Settings())
    assert mesh.counts["probes"] == 0 and mesh.missing_share == 0.0


def test_a_mirror_of_a_pixel_with_many_faces_is_probed_in_little_memory():
    # each face may cover each probe, as the margin round it is wider than the lattice
    corners = np.random.default_rng(3).uniform(40.0, 40.5, (60_000, 3, 2))
    tracemalloc.start()
    covered = probes._covered(corners, np.array([40.0, 40.0]), np.array([0.5, 0.5]) / probes.ACROSS)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert covered.all() and peak < 300e6
