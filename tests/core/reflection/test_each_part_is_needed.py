"""Every part of the method has a scene that gets worse without it: what no scene needs is not modelled.

Each part is taken out alone, in place of what `bounce` or `reflection` call, and the same scene is
judged again: by what a float64 ray tracer sees, or by the work that is counted.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest

import core.bounce
import core.filling.square_cells
import core.reflection
import core.whole_faces.merging
import core.whole_faces.whole
from core import PointTree, Settings, TriangleMesh, View, reflect
from core.cameras import Cameras, camera_splitting, mirror_refinement, picture_areas
from core.culling import SceneAndMirrors
from core.filling import Crowds
from core.filling.crowds import Filled
from core.filling.whole_squares import Holders
from core.points.beams import Beams
from core.polygons import FaceRefinement, Overlaps
from core.trees import Bound, Magnification
from core.trees.closed_bodies import ClosedBodies
from core.trees.shafts import Shafts
from core.visibility.mirror_visibility import DepthGrid
from core.whole_faces import seams
from core.whole_faces.division import Division
from core.whole_faces.layers import Layers
from core.whole_faces.sinking import Sinking
from tests.inputs import near_eyes, shapes
from tests.inputs.dense_scenes import dense, knots_in_a_ball
from tests.oracles.judge import judge
from tests.oracles.raster import rasterise
from tests.oracles.true_map import case_of
from tests.oracles.truth_bounces import trace_bounces

pytestmark = pytest.mark.slow

BOUNCE, REFLECTION = core.bounce, core.reflection
HIDDEN_AND_CLOSE = Layers.hidden_and_close
BALLS = shapes.combine(shapes.icosphere((0.0, 0.0, 1.0), 0.8, 3), shapes.icosphere((0.5, -1.5, 1.0), 0.3, 3))
FLOOR = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, 3.0, 0.0)))
BOXES = shapes.combine(*(shapes.box((x, y, 0.3), (0.4, 0.4, 1.0), 0.3) for x in (-0.8, 0.0, 0.8) for y in (-0.8, 0.6)))
ROOM = shapes.combine(shapes.box((0.0, 4.0, 2.0), (9.0, 1.0, 6.0)), shapes.box((0.0, -8.0, 2.0), (9.0, 1.0, 6.0)),
                      shapes.box((-4.0, 0.0, 2.0), (1.0, 9.0, 6.0)), shapes.box((4.0, 0.0, 2.0), (1.0, 9.0, 6.0)))
WIDE_FLOOR = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (0.0, 30.0, 0.0)))
FINE_BALL = shapes.combine(shapes.icosphere((0.0, 0.0, 1.0), 0.8, 5))
CROWD = shapes.combine(*(shapes.icosphere((x, -1.5, z), 0.15, 4) for x in (-0.6, 0.0, 0.6) for z in (0.5, 1.0, 1.6)))
SMALL = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (192, 192), field_of_view=0.5)
RAYS = {"maximum_memory": 1e-4}  # holds hardly a candidate, and leaves everything to rays
ALL = {"hidden_faces": True}  # so that no ray shows what would be cut
TILES = shapes.combine(shapes.sheet(lambda u, v: (
    np.stack((u, v, 0.0 * u), axis=1), np.tile((0.0, 0.0, 1.0), (len(u), 1))), 24, 24, (-3.0, 3.0), (-3.0, 3.0)))
VIEW = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (256, 256), field_of_view=0.5)
LOW = View.looking_at((0.0, -2.0, 1.6), (0.0, 2.0, 0.4), (256, 256), field_of_view=0.9)


def posters() -> TriangleMesh:
    """Upright sheets of many triangles, which stand in the floor."""
    def upright(x, y):
        return lambda u, v: (np.stack((x + u, y + 0.0 * u, v), axis=1), np.tile((0.0, -1.0, 0.0), (len(u), 1)))
    return shapes.combine(*(shapes.sheet(upright(x, y), 24, 72, (-0.2, 0.2), (-0.3, 0.8))
                            for x in (-0.8, 0.0, 0.8) for y in (-0.8, 0.6)))


@dataclass(frozen=True)
class Part:
    """A part, a scene that needs it, and what gets worse.

    Attributes
    ----------
    owner, name : whose attribute is replaced
    without : what stands in its place
    scene : (view, mirror, scene), or the name of one of the scenes of the tests
    worse : str
        A number of the judgement, or a count of the mesh.
    by : float
        How many times as large, and more than `above`, it must be without the part.
    """

    owner: object
    name: str
    without: Callable
    scene: tuple | str
    worse: str
    by: float = 2.0
    above: float = 0.0
    settings: dict = field(default_factory=dict)


def nobody_hidden(cameras: Cameras) -> tuple[Cameras, DepthGrid]:
    return cameras, DepthGrid.of(cameras)[0]


def only_hidden(self: Layers, *given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    hidden, close = HIDDEN_AND_CLOSE(self, *given)
    return hidden, np.zeros_like(close)


PARTS = {
    "refinement of the mirror": Part(BOUNCE, "refine_mirror", lambda cameras, *_: (cameras, 0), "coarse ball",
                                     "uncovered"),
    "straight outlines": Part(BOUNCE, "refine_for_outlines", lambda candidates, *_: (
        candidates, np.zeros(len(candidates.cameras), dtype=bool), 0), "cylinder", "uncovered"),
    "refinement of faces": Part(FaceRefinement, "refine", lambda self, nodes, faces, *_: (
        nodes, faces, np.zeros((2, 1)), 0), "sphere", "p99"),
    "caustics": Part(BOUNCE, "split_at_caustics", lambda cameras, frames, nodes, faces: (nodes, faces, 0), "bowl",
                     "folded"),
    "the horizon": Part(REFLECTION, "cut_at_horizon", lambda cameras: cameras, "sphere", "cameras", 1.3),
    "the picture's border": Part(mirror_refinement, "shares_in_picture", lambda cameras, ends: np.full(len(ends), 0.5),
                                 near_eyes.drawn(151), "cameras", 3.0),
    "cameras beside the picture": Part(camera_splitting, "_parted", lambda clip, corners, margin: np.zeros(
        len(corners), dtype=bool), near_eyes.drawn(181), "cameras", 1.5),
    "the mirror's own body": Part(REFLECTION, "without_occluded", lambda mirror, cameras, grid: (cameras, 0, 0),
                                  "torus", "spill", 10.0),
    "hidden cameras": Part(REFLECTION, "without_hidden", nobody_hidden, "torus", "self_occluded", 1.5),
    "contacts": Part(BOUNCE, "drop_behind_contacts", lambda candidates, *_: (
        candidates, np.zeros(len(candidates.cameras), dtype=bool), 0, 0), (VIEW, FLOOR, BOXES), "uncovered", above=0.1),
    "mirrors before the scene": Part(BOUNCE, "cut_behind_mirrors", lambda met, polygons: (polygons, 0, 0),
                                     (VIEW, BALLS, ROOM), "spill", 10.0, settings=ALL),
    "shafts": Part(Shafts, "hold", lambda self, shaft, positions, corners: np.ones(len(shaft), dtype=bool), "cylinder",
                   "pairs", 3.0, settings=ALL),
    "neighbours that only touch": Part(BOUNCE, "plainly_seen", lambda met, candidates: np.ones(
        len(candidates), dtype=bool), "torus", "candidates", 1.08, settings=ALL),
    "what mirrors hide from whole cameras": Part(Overlaps, "in_sight", lambda self, last: self.candidates, "torus",
                                                 "candidates", 1.3, settings=ALL),
    "the eye's plane": Part(REFLECTION, "cut_before_eye", lambda cameras: cameras, (LOW, WIDE_FLOOR, ROOM), "faces"),
    "filling by rays": Part(Crowds, "filled", lambda self, candidates: Filled(
        candidates, np.zeros((0, 3), dtype=np.int64), 0, 0, False), "sphere", "uncovered", 10.0, settings=RAYS),
    "whole squares": Part(Holders, "_inner", lambda self, lattice: np.zeros(0, dtype=np.int64),
                          (SMALL, FINE_BALL, ROOM), "faces", settings=RAYS),
    "middles of cells": Part(core.filling.square_cells, "_round_middles", lambda cells, some, spots: (
        cells, np.arange(len(cells))), (SMALL, BALLS, ROOM), "maximum", settings=RAYS),
    "what hides what rays show": Part(SceneAndMirrors, "hidden_within", lambda self, origin, ray, reach: np.zeros(
        len(reach), dtype=bool), (VIEW, FLOOR, BOXES), "uncovered", above=0.1, settings=RAYS),
    "whole faces": Part(REFLECTION, "whole_faces", lambda *_: None, "dense sphere", "projections"),
    "contacts of whole faces": Part(core.whole_faces.whole, "contacts", lambda patch, tree: (
        np.zeros(0, dtype=np.int64), np.zeros(len(patch), dtype=bool)), (VIEW, TILES, posters()), "uncovered",
                                    above=0.05),
    "sinking faces": Part(Sinking, "too_deep", lambda self, images, a, b: np.zeros(len(a), dtype=bool),
                          "dense sphere_ortho", "uncovered", 10.0),
    "bodies that turn away": Part(ClosedBodies, "outward_from", lambda self, view: np.zeros(len(self.outward)),
                                  "sphere", "faces", 1.2),
    "small parts drawn together": Part(core.whole_faces.whole, "TOGETHER", 0.0, "fine knots", "faces", 1.2),
    "outlines of what is drawn together": Part(core.whole_faces.merging, "_on_outline", lambda tree, images, standing:
                                               np.zeros(len(standing), dtype=bool), "outlined knots", "uncovered", 2.5,
                                               settings={"tolerance": 2.0}),
    "layers that are close": Part(Layers, "hidden_and_close", only_hidden, "dense sphere", "uncovered", 5.0),
    "the middles of whole faces": Part(Division, "strays_inside", lambda self, images, nodes: np.zeros(
        nodes.shape[1], dtype=bool), "knots", "p99", 1.1),
    "seams": Part(seams, "_on_edges", lambda *_: (np.zeros(0, dtype=np.int64),) * 2 + (np.zeros(0),), "dense sphere",
                  "uncovered", 5.0),
    "cameras that are full": Part(Crowds, "bound", lambda self, cameras: Bound(
        self.limits.pairs, picture_areas(cameras)), (VIEW, BALLS, CROWD), "pairs"),
    "work beside the origin": Part(REFLECTION, "far_corner", lambda mirror: None, "far away", "maximum"),
    "images smaller than a pixel": Part(Magnification, "pixels", lambda self, cones, camera, sphere: np.full(
        len(camera), np.inf), "dust", "images", 10.0, settings={"method": "POINTS"}),
    "beams": Part(Beams, "hold", lambda self, camera, points: np.ones(len(camera), dtype=bool), "sphere", "projections",
                  1.3, settings={"method": "POINTS"}),
}


def scene_of(part: Part) -> tuple[View, TriangleMesh, TriangleMesh | PointTree]:
    if isinstance(part.scene, tuple):
        return part.scene
    if part.scene.startswith("dense") or part.scene.endswith("knots"):
        knots = {"knots": (1024, 1024), "fine knots": (64, 64), "outlined knots": (96, 96)}
        case = knots_in_a_ball(knots[part.scene]) if part.scene in knots else \
            dense(part.scene.split()[1], (256, 256), 0.24)
        return case.view, case.mirror, case.scene
    sphere = case_of("sphere")
    if part.scene == "coarse ball":
        return sphere.view, shapes.combine(shapes.icosphere((0.0, 0.0, 1.3), 1.0, 1)), sphere.scene
    if part.scene == "dust":
        points = np.random.default_rng(5).normal((0.0, -4.0, 1.0), 0.01, (20_000, 3))
        return VIEW, BALLS, TriangleMesh(points, np.zeros((0, 3), dtype=np.int64))
    case = sphere.moved("far", (1e12, -5e11, 3e11)) if part.scene == "far away" else case_of(part.scene)
    return case.view, case.mirror, case.scene


def number(part: Part) -> float:
    view, mirror, scene = scene_of(part)
    mesh = reflect(view, mirror, scene, Settings(**part.settings))
    if part.worse in mesh.counts:
        return float(mesh.counts[part.worse])
    if part.worse == "folded":
        parity = mesh.image_parity[mesh.triangles]
        return float(((parity.min(axis=1) < 0) & (parity.max(axis=1) > 0)).sum())
    if part.worse == "spill":
        # pixels in which the mesh shows the scene where rays meet a mirror, or nothing
        truth, drawn = trace_bounces(view, mirror, scene, mirror, 1), rasterise(view, mesh.positions, mesh.triangles)
        return float((truth.seen & ~truth.bent & (truth.source < 0) & (drawn.triangle >= 0)).sum())
    return float(judge(view, mirror, scene, mesh)[part.worse])


@pytest.mark.parametrize("name", PARTS)
def test_a_scene_gets_worse_without(name, monkeypatch):
    part = PARTS[name]
    # mirrors of small triangles would else be made backwards, without any of these parts
    monkeypatch.setattr(REFLECTION, "_backward", lambda *_: None)
    with_it = number(part)
    monkeypatch.setattr(part.owner, part.name, part.without)
    without = number(part)
    assert without > max(part.by * with_it, part.above)
