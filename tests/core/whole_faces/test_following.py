"""Images that are followed lie where the law of reflection has them: closed form, and a reflection made anew."""
from dataclasses import replace

import numpy as np
import pytest

from core import FollowedImages, Settings, TriangleMesh, View, following, reflect
from tests.inputs import scenes, shapes
from tests.oracles.judge import judge
from tests.oracles.truth import trace


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("known", [False, True])
def test_in_a_flat_mirror_they_lie_before_their_twins(orthographic, known):
    """The eye and the scene move; a twin beyond the mirror's rim has no image, and every other one has."""
    rng = np.random.default_rng(7)
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)))
    corners = rng.uniform((-3.0, -3.0, 1.0), (3.0, 3.0, 3.0), (60, 1, 3)) + rng.normal(scale=0.2, size=(60, 3, 3))
    scene = TriangleMesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
    size = 14.0 if orthographic else 0.0
    view = View.looking_at((1.0, -2.0, 9.0), (0.0, 0.0, 0.0), (400, 300), field_of_view=1.2, orthographic_scale=size)
    mesh = reflect(view, mirror, scene)
    if not known:
        mesh = replace(mesh, mirror_face=np.full(len(mesh.triangles), -1))
    images = FollowedImages.of(view, mirror, mesh)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    for step in (0.0, 0.1, 0.3, 0.8):
        view = View.looking_at((1.0 + step, -2.0, 9.0), (0.0, 0.0, 0.0), (400, 300), field_of_view=1.2,
                               orthographic_scale=size)
        moved = TriangleMesh(scene.positions + step * turn[0] * (1.0, 1.0, 0.2), scene.triangles)
        now = images.seen(view, mirror, moved, "SURFACE")
        images = now.images
        point = np.einsum("kn,nkc->nc", images.weights, moved.positions[moved.triangles[images.source]])
        np.testing.assert_allclose(now.reflected_position, point, rtol=0, atol=1e-12)
        ahead = view.directions(twin := point * (1.0, 1.0, -1.0))
        seen = twin - (twin[:, 2] / ahead[:, 2])[:, None] * ahead
        beyond = np.abs(seen[:, :2]).max(axis=1) - 4.0
        certain = np.abs(beyond) > 1e-6
        np.testing.assert_array_equal(now.lost[certain], beyond[certain] > 0.0)
        assert 0.3 < (~now.lost).mean() <= 1.0
        np.testing.assert_allclose(now.mirror_position[~now.lost], seen[~now.lost], rtol=0, atol=1e-9)
        np.testing.assert_allclose(now.path_length, np.linalg.norm(point - now.mirror_position, axis=1), rtol=1e-12)
        # what is lost waits on the mirror
        assert np.abs(now.mirror_position[:, :2]).max() < 4.0 + 1e-9
        assert np.abs(now.mirror_position[:, 2]).max() < 1e-12


@pytest.mark.thorough
def test_what_is_lost_is_looked_for_in_turns_and_as_good_as_ever(monkeypatch):
    """On a ball, whose rim takes images away: each is looked for every few times, and few are missed by that."""
    case = scenes.sphere((240, 240))
    mesh = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.3))
    images = FollowedImages.of(case.view, case.mirror, mesh)
    looked, look = [], following.settle

    def settle(mirror_map, face, *more):
        looked.append(len(face))
        return look(mirror_map, face, *more)
    monkeypatch.setattr(following, "settle", settle)
    lost, asked = {}, {}
    for always in (False, True):
        now, lost[always] = images, []
        # standing still at the end, hardly anything but what is lost is out of its triangle
        for step in [*range(12), *range(12, -1, -1), *[0] * following.LOOKS]:
            placement = case.view.camera_to_world.copy()
            placement[:3, 3] += 0.03 * step * placement[:3, 0]
            view = replace(case.view, camera_to_world=placement)
            followed = now.seen(view, case.mirror, case.scene, "SURFACE")
            now = replace(followed.images, lost=np.zeros_like(followed.lost)) if always else followed.images
            lost[always].append(followed.lost.sum())
        asked[always] = looked[-following.LOOKS:]
    assert max(asked[False]) < 0.5 * min(asked[True])
    assert sum(asked[False]) > 0.8 * lost[False][-1]
    assert np.mean(lost[False]) < 1.1 * np.mean(lost[True])


@pytest.mark.thorough
@pytest.mark.parametrize("known", [False, True])
def test_on_a_ball_the_faces_stay_right_while_the_eye_goes_on(known):
    case = scenes.sphere((96, 96))
    mesh = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.1))
    if not known:
        mesh = replace(mesh, mirror_face=np.full(len(mesh.triangles), -1))
    images = FollowedImages.of(case.view, case.mirror, mesh)
    for step in range(5):
        placement = case.view.camera_to_world.copy()
        placement[:3, 3] += 0.05 * step * placement[:3, 0]
        view = replace(case.view, camera_to_world=placement)
        now = images.seen(view, case.mirror, case.scene, "LAYERED")
        images = now.images
    followed = replace(mesh, positions=now.positions, reflected_position=now.reflected_position,
                       mirror_position=now.mirror_position, path_length=now.path_length)
    truth = trace(view, case.mirror, case.scene)
    found, stays = (judge(view, case.mirror, case.scene, one, truth) for one in (followed, mesh))
    assert found["p99"] < 0.3 and found["uncovered"] < 1.0
    assert stays["p99"] > 3.0 * found["p99"]
