"""Openings: made by hand in meshes that have none, found where they are, and filled until rays meet no difference."""
import numpy as np
import pytest

import core.filling
import core.ray_cells
import core.bounce
from core import Settings, reflect
from core.clipping import CONTACT, SCENE_EDGE, whole_triangles
from core.openings import find_openings
from core.unmatched_edges import following_corners, unmatched_edges
from tests.core.true_map import case_of, mesh_of, truth_of
from tests.judge import compare

PIXELS = 512
SCENES = ["sphere", "sphere_ortho", "bowl", "torus", "water", "cylinder", "flat"]
LOST = 0.02
# the ring sees itself: cameras beside what it hides are small, and a few lost in a row leave no edge to be missed
BESIDE_MIRRORS = {"torus": 0.01}


def rooms(monkeypatch, name, settings=Settings()):
    """What `fill_openings` is given for a scene, by name."""
    given = []

    def keep(*arguments):
        given.extend(arguments)
        return original(*arguments)

    original = core.filling.fill_openings
    monkeypatch.setattr(core.bounce, "fill_openings", keep)
    case = case_of(name)
    reflect(case.view, case.mirror, case.scene, settings)
    names = ("view", "mirror_map", "cameras", "tree", "frames", "images", "candidates", "polygons", "nodes", "node_of")
    return dict(zip(names, given, strict=True))


def without(room, lost):
    """The same rooms without the polygons `lost` (q,)."""
    size = np.diff(room["polygons"].start)
    return room | {"polygons": room["polygons"].select(~lost), "node_of": room["node_of"][np.repeat(~lost, size)]}


def openings_of(room):
    keys = ("view", "mirror_map", "cameras", "tree", "frames", "candidates", "polygons", "node_of")
    return find_openings(*(room[key] for key in keys), room["view"].pixels(room["nodes"].place.T),
                         np.ones(len(room["cameras"]), dtype=bool))


def unmatched_of(room):
    keys = ("cameras", "tree", "frames", "candidates", "polygons", "node_of")
    return unmatched_edges(*(room[key] for key in keys))


def losing(share, seed):
    """A clip that loses a share of the polygons."""
    def clip(candidates):
        polygons = original(candidates)
        return polygons.select(np.random.default_rng(seed).random(len(polygons.pair)) >= share)
    original = core.bounce.clip
    return clip


def unfilled(*arguments):
    return *arguments[6:], {"filled": 0, "rays": 0}


def numbers_of(name, mesh):
    case = case_of(name, PIXELS)
    return compare(case.view, case.mirror, mesh, truth_of(name, PIXELS)).numbers


def reflected(name):
    case = case_of(name, PIXELS)
    return reflect(case.view, case.mirror, case.scene)


@pytest.mark.parametrize("name", SCENES)
def test_whole_meshes_have_hardly_an_opening(name):
    mesh = mesh_of(name, PIXELS)
    # slivers at the silhouettes of the ball and the ring, narrower than a pixel
    assert mesh.counts["open"] <= mesh.counts["openings"] <= (1 if name in ("sphere_ortho", "torus") else 0)
    assert mesh.counts["unfilled"] == 0
    assert mesh.filled_share < 0.002


def test_on_a_flat_mirror_each_edge_meets_its_partner(monkeypatch):
    room = rooms(monkeypatch, "flat")
    assert len(room["polygons"].pair) > 300
    assert len(unmatched_of(room)[0]) == 0


def test_the_edges_round_a_lost_polygon_are_found(monkeypatch):
    room = rooms(monkeypatch, "flat")
    polygons, size = room["polygons"], np.diff(room["polygons"].start)
    polygon = np.repeat(np.arange(len(size)), size)
    column = room["candidates"].column[polygons.pair]
    # the triangles of the ball have neighbours all round, and those of one camera alone meet no border
    ball = room["frames"].triangle[column] >= 2 + 36
    ball = np.flatnonzero(ball & (np.bincount(column)[column] == 1) & (size == 3))
    inner = [index for index in ball if ((polygons.after[polygon == index] >= SCENE_EDGE)
                                         & (polygons.after[polygon == index] < CONTACT)).all()]
    assert len(inner) > 50
    for index in inner[::10]:
        lost = np.zeros(len(size), dtype=bool)
        lost[index] = True
        edge, camera, partner = unmatched_of(without(room, lost))
        assert len(edge) == 3
        assert (partner == column[index]).all()
        assert (camera == room["candidates"].camera[polygons.pair[index]]).all()


@pytest.mark.parametrize("name", ["flat", "sphere", "bowl"])
def test_openings_lie_where_polygons_were_lost(monkeypatch, name):
    room = rooms(monkeypatch, name)
    candidates, polygons = room["candidates"], room["polygons"]
    lost = np.random.default_rng(131).random(len(polygons.pair)) < LOST
    found = openings_of(without(room, lost))
    assert len(found) > 10
    pairs = set(zip(candidates.camera[polygons.pair[lost]].tolist(), candidates.column[polygons.pair[lost]].tolist()))
    right = [pair in pairs for pair in zip(found.camera.tolist(), found.column.tolist())]
    # a place at a rim may be seen by the next camera
    assert np.mean(right) > 0.95
    assert found.rays < 20 * found.edges


@pytest.mark.parametrize("name", ["sphere", "bowl", "water", "torus"])
def test_lost_polygons_are_found_by_rays_and_joined_on_the_same_nodes(monkeypatch, name):
    monkeypatch.setattr(core.bounce, "clip", losing(LOST, 137))
    whole, again = mesh_of(name, PIXELS), reflected(name)
    monkeypatch.setattr(core.bounce, "fill_openings", unfilled)
    broken = numbers_of(name, reflected(name))
    before, after = numbers_of(name, whole), numbers_of(name, again)
    assert broken["uncovered"] > 10.0 * before["uncovered"]
    assert after["uncovered"] < before["uncovered"] + BESIDE_MIRRORS.get(name, 0.005)
    assert after["p99"] < 0.5
    assert again.counts["openings"] > 0 and again.counts["open"] == 0 and again.counts["filled"] > 0
    assert 0.2 < again.filled_share < 5.0
    # the faces round what was lost have the vertices that they always had
    places = {tuple(place) for place in np.round(whole.positions, 9).tolist()}
    assert np.mean([tuple(place) in places for place in np.round(again.positions, 9).tolist()]) > 0.995


@pytest.mark.parametrize("name", ["sphere", "bowl", "torus"])
def test_cells_fill_what_no_clip_gives(monkeypatch, name):
    monkeypatch.setattr(core.bounce, "clip", losing(LOST, 139))
    nothing = np.zeros(0, dtype=np.int64)
    clip = core.filling.clip
    monkeypatch.setattr(core.filling, "clip", lambda candidates: clip(candidates.select(nothing)))
    before, mesh = numbers_of(name, mesh_of(name, PIXELS)), reflected(name)
    after = numbers_of(name, mesh)
    assert mesh.counts["filled"] > 500 and mesh.counts["unfilled"] == 0
    assert after["hole"] < before["hole"] + 0.005 + BESIDE_MIRRORS.get(name, 0.005)
    assert after["spill"] < before["spill"] + 0.02
    assert after["wrong_layer"] < before["wrong_layer"] + 0.02
    assert after["p99"] < 0.5


def test_pairs_that_the_tree_loses_are_found_again(monkeypatch):
    def lossy(*arguments):
        cameras, candidates, *rest = original(*arguments)
        kept = np.random.default_rng(149).random(len(candidates)) >= LOST
        return cameras, candidates.select(kept), *rest
    original = core.bounce.refine_for_outlines
    monkeypatch.setattr(core.bounce, "refine_for_outlines", lossy)
    before, mesh = numbers_of("bowl", mesh_of("bowl", PIXELS)), reflected("bowl")
    assert mesh.counts["filled"] > 10
    assert numbers_of("bowl", mesh)["uncovered"] < before["uncovered"] + 0.005


@pytest.mark.parametrize("name", ["sphere", "bowl"])
def test_polygons_with_a_corner_astray_are_found_and_filled(monkeypatch, name):
    room = rooms(monkeypatch, name)
    polygons, nodes, node_of = room["polygons"], room["nodes"], room["node_of"].copy()
    pixels, size = room["view"].pixels(nodes.place.T), np.diff(polygons.start)
    spots = pixels[node_of]
    (x, y), (next_x, next_y) = spots.T, spots[following_corners(polygons)].T
    area = 0.5 * np.abs(np.add.reduceat(x * next_y - y * next_x, polygons.start[:-1]))
    large = np.flatnonzero((area > 10.0) & (area < 200.0) & (size == 3))
    astray = polygons.start[np.random.default_rng(151).choice(large, 20, replace=False)]
    # one corner of each goes to the middle of the two others, so that nothing is left of the polygon
    ends = nodes.place[:, node_of[astray + 1]] + nodes.place[:, node_of[astray + 2]]
    node_of[astray] = len(nodes.distance) + np.arange(20)
    nodes = nodes.joined(0.5 * ends, nodes.point[:, room["node_of"][astray]], nodes.distance[room["node_of"][astray]])
    broken = room | {"nodes": nodes, "node_of": node_of}
    pair = polygons.pair[np.searchsorted(polygons.start, astray)]
    pairs = np.stack((room["candidates"].camera[pair], room["candidates"].column[pair]))
    found = openings_of(broken)
    # some lie behind others: no ray meets them
    hit = {tuple(one) for one in np.stack((found.camera, found.column)).T.tolist()} & {
        tuple(one) for one in pairs.T.tolist()}
    assert len(hit) >= 8
    candidates, after, nodes, node_of, counts = core.filling.fill_openings(*broken.values())
    assert counts["open"] <= 1 and counts["filled"] > 100 and counts["unfilled"] == 0
    assert len(openings_of(broken | {"candidates": candidates, "polygons": after, "nodes": nodes,
                                     "node_of": node_of})) <= 1
    # cells that share a corner and a triangle share its node
    cells = node_of[len(broken["node_of"]):].reshape(-1, 3)
    assert len(np.unique(cells)) < 1.5 * len(cells)
    lost = area[np.searchsorted(polygons.start, astray)].sum()
    assert 0.3 * lost < counts["filled_pixels"] < 1.5 * lost


def test_the_bound_on_cells_is_kept_and_told(monkeypatch):
    monkeypatch.setattr(core.bounce, "clip", losing(LOST, 139))
    nothing = np.zeros(0, dtype=np.int64)
    clip = core.filling.clip
    monkeypatch.setattr(core.filling, "clip", lambda candidates: clip(candidates.select(nothing)))
    monkeypatch.setattr(core.ray_cells, "MOST_CELLS", 100)
    mesh = reflected("bowl")
    assert mesh.counts["unfilled"] == 1
    assert mesh.counts["filled"] < 5000


def test_triangles_seen_whole_are_told_from_cut_ones(monkeypatch):
    room = rooms(monkeypatch, "flat")
    polygons, size = room["polygons"], np.diff(room["polygons"].start)
    weights = np.full((3, len(polygons.after)), np.nan)
    pair = np.repeat(polygons.pair, size)
    weights = room["frames"].weights(room["candidates"].column[pair], room["nodes"].point[:, room["node_of"]])
    at_vertex = (weights > 1.0 - 1e-9).any(axis=0)
    whole = np.add.reduceat(at_vertex.astype(int), polygons.start[:-1])
    expected = int(((whole == 3) & (size == 3)).sum())
    assert 0 < expected < len(size)
    assert whole_triangles(polygons) == expected
    counts = mesh_of("flat").counts
    assert counts["joined"] == expected and counts["joined"] + counts["cut"] == counts["polygons"]
