"""The checks of the search themselves: each finds the fault that it is there for, and none where there is none."""
from dataclasses import replace

import numpy as np
import pytest

from core import Settings, TriangleMesh, View
from tests.fuzz.checks import picture_checks, twins
from tests.fuzz.drawing.configurations import Configuration
from tests.fuzz.reflecting import Reflected, reflected
from tests.fuzz.trying import checked, twin_problems
from tests.inputs import shapes

GENERAL, POINTS, TWICE = "GENERAL", "POINTS", "TWICE"


def configuration(kind: str) -> Configuration:
    """A ball before a floor, a ball and a wall; after two bounces with a mirror beside it."""
    view = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.2), (96, 96), field_of_view=0.5)
    mirror = shapes.combine(shapes.uv_sphere((0.0, 0.0, 0.0), 1.0, 12, 8))
    scene = shapes.combine(shapes.saddle((0.0, -1.0, -1.1), 6.0, 0.05, 6),
                           shapes.icosphere((0.8, -1.8, -0.4), 0.5, 1),
                           shapes.quad((0.0, -8.0, 0.0), (9.0, 0.0, 0.0), (0.0, 0.0, 9.0)))
    others = shapes.combine(shapes.quad((-1.8, -0.5, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    settings = Settings(method=POINTS if kind == POINTS else GENERAL, depth=2 if kind == TWICE else 1)
    return Configuration(kind, view, mirror, scene, settings, others=others if kind == TWICE else None)


@pytest.fixture(scope="module")
def good():
    """Configurations and their meshes, which nothing is wrong with."""
    made = {kind: configuration(kind) for kind in (GENERAL, POINTS, TWICE)}
    return {kind: (one, reflected(one).mesh) for kind, one in made.items()}


@pytest.mark.parametrize("kind", [GENERAL, POINTS, TWICE])
def test_nothing_is_wrong_with_a_good_mesh(good, kind):
    one, mesh = good[kind]
    assert len(mesh.positions) > 20
    assert checked(one, mesh) == []


def with_one(values, change, at=5):
    """The array with one entry changed."""
    values = values.copy()
    values[at] = change(values[at])
    return values


FAULTS = {
    # what is done to a mesh, and the check that finds it
    "a point shown is no number": ("reflected_position", lambda x: with_one(x, lambda one: one * np.nan), "finite"),
    "a path is no number": ("path_length", lambda x: with_one(x, lambda one: np.inf), "finite"),
    "the error is no number": ("estimated_error", lambda x: np.nan, "finite"),
    "a point too few": ("image_parity", lambda x: x[:-1], "lengths"),
    "a point too few is shown": ("reflected_position", lambda x: x[:-1], "lengths"),
    "a face too few": ("source_face", lambda x: x[:-1], "lengths"),
    "no discs": ("discs", lambda x: None if x is not None else (), "lengths"),
    "a corner out of range": ("triangles", lambda x: with_one(x, lambda one: one + 10**6), "ranges"),
    "a source out of range": ("source_face", lambda x: with_one(x, lambda one: 10**6), "ranges"),
    "a mirror out of range": ("mirror_face", lambda x: with_one(x, lambda one: -2), "ranges"),
    "a bounce too many": ("bounces", lambda x: with_one(x, lambda one: 3), "ranges"),
    "no parity": ("image_parity", lambda x: with_one(x, lambda one: 2), "ranges"),
    "a corner twice": ("triangles", lambda x: with_one(x, lambda one: one[[0, 0, 2]]), "corners"),
    "a face twice": ("triangles", lambda x: with_one(x, lambda one: x[7][[1, 2, 0]]), "corners"),
    "a negative weight": ("source_weights", lambda x: x + [0.0, 1.0, -1.0], "weights"),
    "weights of more than one": ("source_weights", lambda x: with_one(x, lambda one: 1.001 * one), "weights"),
    "a path too short": ("path_length", lambda x: with_one(x, lambda one: 0.99 * one), "paths"),
    "a path too long": ("path_length", lambda x: 1.01 * x, "paths"),
    "a negative path": ("path_length", lambda x: with_one(x, lambda one: -one), "paths"),
    "a point off its source": ("reflected_position", lambda x: with_one(x, lambda one: one + 0.01), "source"),
    "sources changed over": ("source_face", lambda x: np.roll(x, 30), "source"),
    "weights changed over": ("source_weights", lambda x: x[:, :, [1, 2, 0]], "source"),
    "a point off the mirror": ("mirror_position", lambda x: with_one(x, lambda one: 1.01 * one), "mirror"),
    "mirrors changed over": ("mirror_face", lambda x: (x + 40) % 168, "named"),
    "points elsewhere on the mirror": ("mirror_position", lambda x: np.roll(x, 1, axis=0), "rays"),
}


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("kind", [GENERAL, TWICE])
def test_each_fault_of_a_mesh_is_found(good, kind, fault):
    one, mesh = good[kind]
    field, change, found = FAULTS[fault]
    if fault == "no discs":
        one, mesh = good[POINTS]
    problems = checked(one, replace(mesh, **{field: change(getattr(mesh, field))}))
    assert [problem for problem in problems if problem.startswith(found + ":")], problems


@pytest.mark.parametrize("fault", ["reflected_position", "mirror_position", "source_vertex", "mirror_face", "radius"])
def test_each_fault_of_points_is_found(good, fault):
    one, mesh = good[POINTS]
    if fault in ("reflected_position", "mirror_position"):
        wrong = replace(mesh, **{fault: with_one(getattr(mesh, fault), lambda place: 1.02 * place)})
    else:
        shift = 40 if fault == "mirror_face" else np.nan if fault == "radius" else 1
        wrong = replace(mesh, discs=replace(mesh.discs, **{fault: getattr(mesh.discs, fault)[::-1] + shift}))
    assert checked(one, wrong)


def test_what_is_missing_must_be_told(good):
    one, mesh = good[GENERAL]
    half = np.flatnonzero(mesh.positions[mesh.triangles[:, 0], 0] > 0.0)
    part = replace(mesh, counts={**mesh.counts, "missed": 0}, **{
        name: getattr(mesh, name)[half] for name in ("triangles", "source_face", "source_weights", "mirror_face",
                                                     "bounces")})
    assert [problem[:5] for problem in picture_checks.shows_what_rays_see(one, part)] == ["holes"]
    told = replace(part, counts={**mesh.counts, "missed": 3})
    assert not list(picture_checks.shows_what_rays_see(one, told))


def test_what_is_not_there_must_not_be_shown(good):
    one, mesh = good[GENERAL]
    away = replace(one, scene=TriangleMesh(one.scene.positions + [0.0, 0.0, 50.0], one.scene.triangles))
    assert [problem[:5] for problem in picture_checks.shows_what_rays_see(away, mesh)] == ["spill"]
    moved = replace(mesh, reflected_position=mesh.reflected_position + [0.0, 3.0, 0.0])
    assert [problem[:6] for problem in picture_checks.shows_what_rays_see(one, moved)] == ["astray"]
    other = replace(moved, source_face=(mesh.source_face + 7) % len(one.scene.triangles))
    assert [problem[:6] for problem in picture_checks.shows_what_rays_see(one, other)] == ["layers"]


@pytest.mark.parametrize("scale", [0.0, 3.0])
@pytest.mark.parametrize("resolution", [(64, 64), (128, 96), (200, 200), (30, 120), (5, 3), (1, 100)])
def test_the_few_pixels_that_are_asked_are_some_of_the_picture(resolution, scale):
    view = View.looking_at((1.0, 2.0, 3.0), (0.0, 0.0, 0.0), resolution, orthographic_scale=scale)
    few = picture_checks.coarse(view)
    width, height = few.resolution
    middles = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).reshape(-1, 2) + 0.5
    origins, directions = few.rays(middles)
    places = view.pixels(origins + 2.0 * directions)
    np.testing.assert_allclose(places - np.floor(places), 0.5, rtol=0, atol=1e-9)
    np.testing.assert_allclose(places.min(axis=0) + places.max(axis=0), resolution, rtol=0, atol=max(resolution) / 24)
    np.testing.assert_allclose(few.pixels(origins + 2.0 * directions), middles, rtol=0, atol=1e-9)


def test_a_mirror_that_is_seen_is_not_refused(good):
    one, _ = good[GENERAL]
    sentence = "The view does not see the mirror; turn the camera."
    assert list(picture_checks.refused_rightly(one, sentence))
    aside = replace(one, view=View.looking_at((0.3, -5.0, 1.5), (0.0, -9.0, 0.2), (96, 96), field_of_view=0.5))
    assert not list(picture_checks.refused_rightly(aside, sentence))


@pytest.mark.parametrize("name", twins.TWINS)
def test_twins_of_a_good_mesh_are_alike(good, name):
    for one, mesh in good.values():
        assert twin_problems(one, Reflected(mesh), name, np.random.default_rng(4)) == []


@pytest.mark.parametrize("field", ["positions", "triangles", "reflected_position", "image_parity", "source_face",
                                   "source_weights", "mirror_face", "bounces"])
def test_twins_must_agree_to_the_last_bit(good, field):
    one, mesh = good[GENERAL]
    values = getattr(mesh, field)
    other = replace(mesh, **{field: np.nextafter(values, 9.0) if values.dtype == float else np.roll(values, 60, axis=0)
                             if field in ("triangles", "source_face", "mirror_face") else values + 1})
    assert list(twins.same_to_the_bit(mesh, other, 1.0, one, one))
    assert not list(twins.same_to_the_bit(mesh, mesh, 1.0, one, one))


def test_twins_must_be_seen_by_the_same_later_mirrors(good):
    one, mesh = good[TWICE]
    twice = np.flatnonzero(mesh.later_mirrors[:, 0] >= 0)
    later = mesh.later_mirrors.copy()
    assert len(twice) and list(twins.same_to_the_bit(mesh, replace(mesh, later_mirrors=np.full_like(later, -1)), 1.0,
                                                     one, one))
    later[twice[0]] -= 1
    assert list(twins.same_to_the_bit(mesh, replace(mesh, later_mirrors=later), 1.0, one, one))
    assert not list(twins.same_to_the_bit(mesh, mesh, 1.0, one, one))


def test_twins_must_agree_nearly(good):
    one, mesh = good[GENERAL]
    parts = ("triangles", "source_face", "source_weights", "mirror_face", "bounces")
    fewer = replace(mesh, **{name: getattr(mesh, name)[::2] for name in parts})
    more = replace(mesh, **{name: np.tile(getattr(mesh, name), (3, *(getattr(mesh, name).ndim - 1) * (1,)))
                            for name in parts})
    assert "pixels are covered" in next(twins.nearly_the_same(mesh, fewer, one, one, 0.5))
    assert "triangles" in next(twins.nearly_the_same(mesh, more, one, one, 0.5))
    assert not list(twins.nearly_the_same(mesh, mesh, one, one, 0.0))
