"""Environment maps and billboards where they must be right, and in the limits in which they become right."""
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from core import TriangleMesh, View
from core.rivals import primary_hits
from core.rivals.billboards import billboarded, connected_parts
from core.rivals.environment import boxed, centre_of, mapped, panorama
from core.rivals.textures import looked_up
from tests.inputs import shapes
from tests.inputs.scenes import Scene
from tests.oracles.judge import compare_picture
from tests.oracles.true_map import case_of
from tests.oracles.truth import trace

pytestmark = pytest.mark.slow

PIXELS = 96
NAMES = ("median", "p99", "maximum", "uncovered", "compared")


def errors(case, rival, *knobs, **options):
    hits, truth = primary_hits(case.view, case.mirror, case.scene), trace(case.view, case.mirror, case.scene)
    found = []
    for knob in knobs:
        picture = rival(case.view, case.mirror, case.scene, knob, hits, **options)
        found.append(compare_picture(case.view, truth, picture.triangle, picture.position).numbers)
    return found


def scaled(mesh, factor, about):
    return TriangleMesh(about + factor * (mesh.positions - about), mesh.triangles, mesh.corner_normals)


def balls(distance, radius):
    ways = np.random.default_rng(3).normal(size=(24, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    return shapes.combine(*(shapes.icosphere(distance * way, radius, 1) for way in ways))


def distant(distance):
    """A ball of radius 1 that mirrors balls, all `distance` away and as large from there."""
    view = View.looking_at((0.0, -6.0, 0.0), (0.0, 0.0, 0.0), (PIXELS, PIXELS), field_of_view=0.36)
    return Scene("distant", view, shapes.combine(shapes.uv_sphere((0.0, 0.0, 0.0), 1.0, 24, 24)),
                 balls(distance, 0.3 * distance))


def test_an_environment_map_is_right_for_what_is_far_away():
    near, far, farther = (errors(distant(distance), mapped, 256)[0] for distance in (10.0, 1e3, 1e6))
    assert far["compared"] > 1000
    # a texel is a tenth of what a pixel of the ball's picture shows
    assert farther["p99"] < 0.1 and farther["uncovered"] < 1.0
    # the angle between what ball and centre see falls with the distance
    assert far["median"] < 0.02 * near["median"] and near["p99"] > 1.0


def test_an_environment_map_is_right_for_a_tiny_mirror():
    case = case_of("sphere", PIXELS)
    centre = centre_of(case.mirror)
    found = []
    for size in (1.0, 1e-2, 1e-4):
        # the eye comes as near as the mirror is small: its picture stays as large
        placement = case.view.camera_to_world.copy()
        placement[:3, 3] = centre + size * (placement[:3, 3] - centre)
        view = View(placement, case.view.projection, case.view.resolution)
        ball = replace(case, view=view, mirror=scaled(case.mirror, size, centre))
        found += errors(ball, mapped, 256)
    assert found[1]["median"] < 0.05 * found[0]["median"]
    assert found[2]["p99"] < 0.1 and found[2]["uncovered"] < 0.3 and found[2]["compared"] > 2000


def test_more_texels_make_smaller_errors():
    coarse, middle, fine = errors(distant(1e6), mapped, 32, 128, 512)
    assert coarse["p99"] > 3.0 * middle["p99"] > 9.0 * fine["p99"]
    assert coarse["uncovered"] > 2.0 * middle["uncovered"] > 4.0 * fine["uncovered"]


def test_texels_of_the_panorama_show_what_rays_from_its_centre_meet():
    mesh, centre = balls(4.0, 1.5), np.array([0.1, -0.2, 0.3])
    ways = np.random.default_rng(9).normal(size=(4000, 3))
    along = np.argmax(np.abs(ways), axis=1)
    face = 2 * along + (np.take_along_axis(ways, along[:, None], axis=1)[:, 0] < 0.0)
    right, off = 0, []
    for number, (view, texture) in enumerate(panorama(centre, mesh, 256)):
        own = ways[face == number]
        pixels = view.pixels(centre + own / np.abs(own).max(axis=1)[:, None])
        # each direction lies in its own picture, a border inside
        assert pixels.min() > 0.9 and pixels.max() < 257.1
        triangle, position = looked_up(texture, pixels)
        shown = triangle >= 0
        offset = position.T[shown] - centre
        off.append(np.linalg.norm(np.cross(own[shown], offset), axis=1) / np.linalg.norm(own[shown], axis=1)
                   / np.linalg.norm(offset, axis=1))
        right += shown.sum()
    # within half a texel's diagonal of the ray, where texels are largest
    assert right > 1500 and np.concatenate(off).max() < 0.75 * 2.0 / 256


def test_the_box_makes_a_box_right_that_the_plain_map_does_not():
    case = case_of("sphere", PIXELS)
    room = case.moved("room", (0.0, 0.0, 0.0))
    walls = shapes.box((0.4, -1.0, 2.0), (9.0, 12.0, 7.0))
    room = replace(room, scene=shapes.combine(walls))
    plain, box = errors(room, mapped, 256)[0], errors(room, boxed, 256)[0]
    assert plain["median"] > 1.0
    assert box["p99"] < 0.05 and box["uncovered"] < 0.3 and box["compared"] > 3000


def flat_objects():
    """Squares that lie in no axis' plane, beside and behind the eye."""
    rng = np.random.default_rng(2)
    squares = []
    for centre in ((-5.0, -3.0, 0.5), (5.0, -3.5, -0.5), (0.0, -4.0, 4.5), (0.5, -4.0, -4.5), (-2.5, -9.0, 1.0),
                   (2.5, -9.0, -1.5)):
        normal = np.array(centre) / np.linalg.norm(centre) + rng.uniform(-0.5, 0.5, 3)
        right = np.cross(normal, rng.normal(size=3))
        up = np.cross(normal, right)
        squares.append(shapes.quad(centre, 2.2 * right / np.linalg.norm(right), 1.6 * up / np.linalg.norm(up)))
    return replace(distant(10.0), scene=shapes.combine(*squares))


def test_billboards_are_exact_for_objects_that_are_flat():
    case = flat_objects()
    coarse, fine = errors(case, billboarded, 64, 512)
    assert fine["compared"] > 500
    # inside a triangle positions are linear in the texels, whatever their size; edges are as far off as a texel
    assert fine["median"] < 1e-6 and fine["p99"] < 0.1
    assert fine["uncovered"] < 0.25 * coarse["uncovered"] and fine["uncovered"] < 0.5


def test_billboards_are_wrong_for_objects_that_are_not_flat():
    case = case_of("sphere", PIXELS)
    coarse, fine = errors(case, billboarded, 64, 256)
    assert fine["p99"] > 0.5 and fine["uncovered"] > 0.5
    assert fine["median"] < 0.01  # the floor is flat


def test_the_nearer_of_two_billboards_hides_the_other():
    case = flat_objects()
    corners = case.scene.positions
    # each square once more, half as large, halfway to the mirror and further away, in both orders
    for factors in ((1.0, 0.5), (0.5, 1.0)):
        both = [(factor * corners, case.scene.triangles, None) for factor in factors]
        found = errors(replace(case, scene=shapes.combine(*both)), billboarded, 256)[0]
        assert found["wrong_layer"] < 0.3 and found["p99"] < 0.2 and found["compared"] > 500


def test_every_ray_is_tested_with_every_billboard():
    case = flat_objects()
    hits = primary_hits(case.view, case.mirror, case.scene)
    run = billboarded(case.view, case.mirror, case.scene, 32, hits)
    assert run.counts["intersections"] == 6 * len(hits.pixel) and run.counts["projections"] == 24
    one = billboarded(case.view, case.mirror, case.scene, 32, hits, objects=np.zeros(12, dtype=int))
    assert one.counts["intersections"] == len(hits.pixel)


def test_connected_parts_are_those_of_the_graph():
    rng = np.random.default_rng(6)
    triangles = rng.integers(0, 900, (300, 3))
    positions = rng.normal(size=(900, 3))
    # some vertices lie where others do: what touches there hangs together
    positions[600:660] = positions[:60]
    _, place = np.unique(positions, axis=0, return_inverse=True)
    corner = place.reshape(-1)[triangles]
    graph = coo_matrix((np.ones(600), (corner[:, [0, 1]].ravel(), corner[:, [1, 2]].ravel())), shape=(900, 900))
    _, label = connected_components(graph, directed=False)
    parts = connected_parts(TriangleMesh(positions, triangles))
    expected = label[corner[:, 0]]
    assert np.array_equal(parts[:, None] == parts, expected[:, None] == expected) and len(np.unique(parts)) > 5
