"""Light that mirrors throw, against closed forms and rays traced one by one."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core import CausticMesh, Lamp, NothingInView, ReflectionError, Settings, TriangleMesh, View, caustics
from core.cameras import MirrorMap
from core.caustics.corners import light_at
from tests.oracles.ray_hits import first_hits, plane_hits

SIDE = 1.6
RING_LAMPS = (Lamp((3.0, 0.3, 1.6)), Lamp.shining((-1.0, 0.0, -0.4)), Lamp((0.3, 0.2, 1.2)))


def quad(*corners) -> TriangleMesh:
    return TriangleMesh(np.array(corners, dtype=float), np.array([[0, 1, 2], [0, 2, 3]]))


def level(x: float, y: float, z: float, half: float) -> TriangleMesh:
    """A square that lies flat round a place."""
    return quad(*((x + sx * half, y + sy * half, z) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))))


def upright(x: float, z: float, half: float) -> TriangleMesh:
    """A square across x."""
    return quad(*((x, sy * half, z + sz * half) for sy, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))))


def ring(count: int, height: float = 0.5) -> TriangleMesh:
    """An upright smooth ring of radius 1."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    circle = np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    i, j = np.arange(count), (np.arange(count) + 1) % count
    triangles = np.concatenate((np.stack((i, j, count + j), 1), np.stack((i, count + j, count + i), 1)))
    return TriangleMesh(np.concatenate((circle, circle + (0, 0, height))), triangles,
                        np.concatenate((circle, circle))[triangles])


@cache
def light_of_ring(which: int) -> tuple[TriangleMesh, TriangleMesh, CausticMesh]:
    """A ring on a table, and the light that it throws of one of `RING_LAMPS`."""
    mirror, table = ring(96), level(0.0, 0.0, -1e-3, SIDE)
    return mirror, table, caustics(RING_LAMPS[which], mirror, table)


def graph(height, slope, radius: float, count: int) -> TriangleMesh:
    """The surface z = height(r) over a disc, with the exact normals of its `slope`(r)."""
    turn = np.linspace(0.0, 2.0 * np.pi, 6 * count, endpoint=False)
    r = np.append(0.0, np.repeat(np.linspace(0.0, radius, count + 1)[1:], len(turn)))
    angle = np.append(0.0, np.tile(turn, count))
    out = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    positions = np.column_stack((r[:, None] * out, height(r)))
    normals = np.column_stack((-slope(r)[:, None] * out, np.ones(len(r))))
    k, step = np.arange(len(turn)), np.roll(np.arange(len(turn)), -1)
    triangles = [np.stack((np.zeros_like(k), 1 + k, 1 + step), axis=1)]
    for row in range(count - 1):
        low, high = 1 + row * len(turn), 1 + (row + 1) * len(turn)
        triangles += [np.stack((low + k, high + k, high + step), 1), np.stack((low + k, high + step, low + step), 1)]
    triangles = np.concatenate(triangles)
    return TriangleMesh(positions, triangles, normals[triangles])


def bent_strip(tilt: float) -> TriangleMesh:
    """A square across x whose normals turn from its foot, where they look down by `tilt`, to its top."""
    flat, tilts = upright(0.0, 1.5, 0.5), np.array([-tilt, -tilt, 0.0, 0.0])
    normals = np.column_stack((np.ones(4), 0.0 * tilts, tilts)) / np.hypot(1.0, tilts)[:, None]
    return TriangleMesh(flat.positions, flat.triangles, normals[flat.triangles])


def seen_from_below(tilt: float, sun: Lamp) -> float:
    """How much of the strip of `bent_strip` those see whom it shows a sun, across their sight, from top to foot."""
    height = (np.arange(100_000) + 0.5) / 100_000
    foot = np.array([1.0, 0.0, -tilt]) / np.hypot(1.0, tilt)
    normal = height[:, None] * (1.0, 0.0, 0.0) + (1.0 - height)[:, None] * foot
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    way = sun.place - 2.0 * (normal @ sun.place)[:, None] * normal
    return float(np.maximum(way[:, 0], 0.0).mean())


def areas(mesh) -> np.ndarray:
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def received(mesh) -> float:
    """All of the light, by the irradiance on the faces."""
    return float((areas(mesh) * mesh.irradiance.mean(axis=1)).sum())


def solid_angle(place, mesh: TriangleMesh) -> float:
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles] - place, 1, 0)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    low = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(2.0 * np.arctan2(np.abs((a * np.cross(b, c)).sum(1)), low).sum())


def by_rays(lamp: Lamp, mirror: TriangleMesh, receiver: TriangleMesh, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Where rays come to, and what each carries: strewn over all that the lamp sees of the mirror."""
    rng = np.random.default_rng(1)
    if lamp.sun:
        middle, size = mirror.positions.mean(axis=0), 1.1 * np.ptp(mirror.positions, axis=0).max()
        view = View.looking_at(middle - 9.0 * lamp.place, middle, (1024, 1024), orthographic_scale=size)
        start, way = view.rays(rng.uniform(0.0, 1024.0, (count, 2)))
        share = np.full(count, size**2 / count)
    else:
        way = rng.normal(size=(count, 3))
        way /= np.linalg.norm(way, axis=1)[:, None]
        start, share = np.broadcast_to(lamp.place, way.shape), np.full(count, 4.0 * np.pi / count)
    both = TriangleMesh.joined((mirror, receiver))
    met, _ = first_hits(both, start, way)
    own = (met >= 0) & (met < len(mirror.triangles))
    start, way, share, met = start[own], way[own], share[own], met[own]
    along, weights = plane_hits(mirror, met, start, way)
    place = start + along[:, None] * way
    normal = np.einsum("nk,nkc->nc", weights, mirror.corner_normals[met])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    came, flat = way, mirror.face_normals()[met]
    way = way - 2.0 * (way * normal).sum(axis=1)[:, None] * normal
    # as a path tracer would find it
    share = share * np.maximum(-(way * flat).sum(axis=1) / (came * flat).sum(axis=1), 0.0)
    found, _ = first_hits(both, place, way, leaving=met)
    lit = found >= len(mirror.triangles)
    along, _ = plane_hits(receiver, found[lit] - len(mirror.triangles), place[lit], way[lit])
    return place[lit] + along[:, None] * way[lit], share[lit]


def binned(points, share, bins: int) -> np.ndarray:
    return np.histogram2d(points[:, 0], points[:, 1], bins=bins, range=[[-SIDE, SIDE]] * 2, weights=share)[0]


def strewn(mesh, count: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Places on the faces, and the light of each."""
    inner = np.random.default_rng(2).dirichlet((1, 1, 1), (len(mesh.triangles), count))
    points = np.einsum("nsk,nkc->nsc", inner, mesh.positions[mesh.triangles])
    light = np.einsum("nsk,nk->ns", inner, mesh.irradiance) * (areas(mesh) / count)[:, None]
    return points.reshape(-1, 3), light.ravel()


def test_a_flat_mirror_throws_light_as_from_the_lamp_behind_it():
    mesh = caustics(Lamp((1.0, 0.0, 3.0)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0))
    way = mesh.positions[mesh.triangles] - (-1.0, 0.0, 3.0)
    expected = 3.0 / np.linalg.norm(way, axis=2)**3
    # no value is off by more than what is linear on a face may be
    assert np.abs(mesh.irradiance / expected - 1.0).max() < 0.03
    assert np.median(np.abs(mesh.irradiance / expected - 1.0)) < 1e-3
    assert np.abs(mesh.direction - way / np.linalg.norm(way, axis=2, keepdims=True)).max() < 1e-9
    whole = solid_angle((1.0, 0.0, 3.0), upright(0.0, 1.5, 0.5))
    assert abs(mesh.flux.sum() / whole - 1.0) < 1e-9 and abs(received(mesh) / whole - 1.0) < 1e-9
    # turned to the side that is lit
    normal = np.cross(*(mesh.positions[mesh.triangles[:, k]] - mesh.positions[mesh.triangles[:, 0]] for k in (1, 2)))
    assert (normal[:, 2] > 0.0).all() and (mesh.image_parity == 1).all()


def test_irradiance_is_what_a_path_tracer_finds_that_comes_from_the_receiver():
    """A lamp of 1 W/sr and the area A across its light is as bright as 1 / A, in the solid angle in which it is
    seen."""
    normals = np.array([(1.0, -0.3, 0.1), (1.0, 0.2, -0.1), (1.0, 0.1, 0.2)])
    mirror = TriangleMesh(np.array([(0.0, -0.4, 1.2), (0.1, 0.5, 1.1), (0.0, 0.0, 1.9)]), np.array([[0, 1, 2]]),
                          normals[None])
    view, up = View.looking_at((1.5, 0.2, 3.0), (0.0, 0.0, 1.4), (64, 64)), np.array([0.0, 0.0, 1.0])
    ray_map, face = MirrorMap(view, mirror), np.zeros(1, dtype=int)
    unit_normals = normals / np.linalg.norm(normals, axis=1)[:, None]
    for u, v in ((0.2, 0.3), (0.5, 0.1), (0.1, 0.7)):
        inner = np.array([(u, v), (u + 1e-5, v), (u, v + 1e-5)])
        inner = np.column_stack((1.0 - inner.sum(axis=1), inner))
        place, normal = inner @ mirror.positions, inner @ unit_normals
        normal /= np.linalg.norm(normal, axis=1)[:, None]

        def sent_on(way: np.ndarray, normal: np.ndarray = normal) -> np.ndarray:
            return way - 2.0 * (way * normal).sum(axis=1)[:, None] * normal
        way = sent_on(place - view.eye)[0]
        point = place[0] - place[0, 2] / way[2] * way
        seen, back = place - point, sent_on(place - point)
        across = place[0] - view.eye
        back *= (((view.eye - place) @ across) / (back @ across))[:, None]
        ends = place + back
        area = 0.5 * np.linalg.norm(np.cross(ends[1] - ends[0], ends[2] - ends[0]))
        a, b, c = seen
        angle = 0.5 * abs(a @ np.cross(b - a, c - a)) / np.linalg.norm(a)**3
        found = light_at(ray_map, face, np.array([[u], [v]]), point[:, None], up[:, None], Lamp(view.eye))
        assert abs(found.irradiance[0] * area / (angle * a[2] / np.linalg.norm(a)) - 1.0) < 1e-3
        assert found.arrived[0] and found.side[0] == 1.0


def test_normals_far_from_the_faces_bring_the_light_that_a_path_tracer_finds():
    """Of a sun of 1 W/m2 it finds as much as what it sees of the mirror where that shows the sun."""
    mirror, floor, sun = bent_strip(0.35), level(0.0, 0.0, -3.0, 60.0), Lamp.shining((-1.0, 0.0, -1.0))
    expected = seen_from_below(0.35, sun)
    assert abs(expected - np.sqrt(0.5)) > 0.1  # which is what the mirror takes of the light
    mesh = caustics(sun, mirror, floor)
    assert abs(mesh.flux.sum() / expected - 1.0) < 1e-3 and abs(received(mesh) / mesh.flux.sum() - 1.0) < 1e-9


def test_what_stands_in_the_way_casts_its_shadow_exactly():
    lamp, mirror, floor = Lamp((1.0, 0.0, 3.0)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0)
    whole = solid_angle(lamp.place, mirror)
    before = upright(0.4, 2.1, 0.1)  # between lamp and mirror
    mesh = caustics(lamp, mirror, floor, blockers=before)
    assert abs(mesh.flux.sum() - (whole - solid_angle(lamp.place, before))) < 1e-9
    after = level(0.8, 0.0, 0.6, 0.1)  # between mirror and floor, beside the lamp's own light on the mirror
    mesh = caustics(lamp, mirror, floor, blockers=after)
    hidden = solid_angle((-1.0, 0.0, 3.0), after)
    assert abs(mesh.flux.sum() - (whole - hidden)) < 1e-9
    # the same square lit instead: it takes the light, and the floor has none behind it
    mesh = caustics(lamp, mirror, TriangleMesh.joined((floor, after)))
    high = mesh.source_face >= 2
    assert abs(mesh.flux[high].sum() - hidden) < 1e-9 and abs(mesh.flux.sum() - whole) < 1e-9


@pytest.mark.thorough
def test_a_paraboloid_sends_parallel_light_to_its_focus():
    dish = graph(lambda r: 0.25 * r**2, lambda r: 0.5 * r, 0.8, 12)  # its focus is (0, 0, 1)
    before, half = 0.05, 0.06  # of a plate before it
    mesh = caustics(Lamp.shining((0.0, 0.0, -1.0)), dish, level(0.0, 0.0, 1.0 - before, half))
    rim = dish.positions[-6 * 12:, :2]
    area = 0.5 * (rim[:, 0] * np.roll(rim[:, 1], -1) - rim[:, 1] * np.roll(rim[:, 0], -1)).sum()
    assert abs(mesh.flux.sum() / (area - 4.0 * half**2) - 1.0) < 2e-3
    # all rays come to the plate on straight ways to the focus
    shrunk = before / (1.0 - mesh.mirror_position[:, 2:])
    assert np.abs(mesh.positions[:, :2] - mesh.mirror_position[:, :2] * shrunk).max() < 3e-3
    assert np.isfinite(mesh.irradiance).all()


def test_a_ball_scatters_parallel_light_as_its_closed_form_says():
    cap = graph(lambda r: np.sqrt(1.0 - r**2), lambda r: -r / np.sqrt(1.0 - r**2), 0.45, 24)
    height, hole, rim = 3.0, 0.5, 9.0  # a ceiling with a hole for the sun
    corners = [(sx * k, sy * k, height) for k in (hole, rim) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    ceiling = TriangleMesh(np.array(corners), np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]))
    mesh = caustics(Lamp.shining((0.0, 0.0, -1.0)), cap, ceiling)
    # at the angle t from the top, light comes to r(t), and pi sin(t)^2 of it comes within
    t = np.arcsin(np.linalg.norm(mesh.mirror_position[:, :2], axis=1))
    r = np.sin(t) + (height - np.cos(t)) * np.tan(2.0 * t)
    rise = np.cos(t) + np.sin(t) * np.tan(2.0 * t) + 2.0 * (height - np.cos(t)) / np.cos(2.0 * t)**2
    assert np.abs(np.linalg.norm(mesh.positions[:, :2], axis=1) - r).max() < 5e-3
    inside = (r > 0.8) & (t < 0.4)
    expected = np.where(inside, np.sin(t) * np.cos(t) / np.maximum(r * rise, 1e-12), np.nan)[mesh.triangles]
    ratio = (mesh.irradiance / expected)[np.isfinite(expected)]
    assert abs(np.median(ratio) - 1.0) < 5e-3 and np.percentile(np.abs(ratio - 1.0), 95) < 0.05


@pytest.mark.thorough
def test_the_light_of_a_ring_is_that_of_rays():
    for which, lamp in enumerate(RING_LAMPS):
        mirror, table, mesh = light_of_ring(which)
        points, share = by_rays(lamp, mirror, table, 500_000 if lamp.sun else 2_500_000)
        noise = np.sqrt((share**2).sum())
        assert abs(mesh.flux.sum() - share.sum()) < max(4.0 * noise, 0.002 * share.sum())
        assert abs(received(mesh) / mesh.flux.sum() - 1.0) < 1e-9
        ours, theirs = binned(*strewn(mesh), 32), binned(points, share, 32)
        spread = np.sqrt(theirs * share.mean())
        assert np.abs(ours - theirs).sum() < 1.2 * np.sqrt(2.0 / np.pi) * spread.sum() + 0.01 * theirs.sum()
        assert np.isfinite(mesh.irradiance).all() and mesh.irradiance.min() >= 0.0


@pytest.mark.slow
def test_places_on_one_lamp_need_fewer_faces_and_their_light_is_that_of_rays():
    """Which are asked from each of the places."""
    table, mirror = level(0.0, 0.0, -1e-3, SIDE), ring(96)
    lamps = [Lamp((3.0 + 0.2 * np.cos(angle), 0.3 + 0.2 * np.sin(angle), 1.6)) for angle in np.arange(12) * np.pi / 6.0]
    alone, of_one = ([caustics(replace(lamp, places=places), mirror, table) for lamp in lamps] for places in (1, 12))
    assert sum(len(mesh.triangles) for mesh in of_one) < 0.65 * sum(len(mesh.triangles) for mesh in alone)
    rays = [by_rays(lamp, mirror, table, 1_000_000) for lamp in lamps]
    points, share = (np.concatenate(each) for each in zip(*rays))
    theirs = binned(points, share, 32)
    spread = np.sqrt(theirs * share.mean())
    for meshes in (alone, of_one):
        ours = sum(binned(*strewn(mesh, 16), 32) for mesh in meshes)
        assert np.abs(ours - theirs).sum() < 1.2 * np.sqrt(2.0 / np.pi) * spread.sum() + 0.01 * theirs.sum()
        assert abs(ours.sum() / theirs.sum() - 1.0) < 0.002


@pytest.mark.thorough
def test_the_cusp_of_a_ring_lies_at_half_its_radius():
    mesh = caustics(Lamp.shining((-1.0, 0.0, -0.4)), ring(360), level(0.0, 0.0, 0.0, SIDE))
    fold = mesh.positions[mesh.image_parity == 0]
    fold = fold[np.abs(fold[:, 1]) < 1e-3]
    assert abs(fold[:, 0].max() + 0.5) < 1e-3


def test_several_bounces_go_on_from_mirror_to_mirror():
    lamp, floor = Lamp((1.0, 0.0, 4.0)), level(0.0, 0.0, 0.0, 9.0)
    first, second = upright(0.0, 3.0, 0.5), upright(0.5, 2.0, 0.5)
    one = caustics(lamp, first, floor, mirrors=second)
    two = caustics(lamp, first, floor, Settings(depth=2), mirrors=second)
    # by the first mirror the lamp is at x = -1, by the second that is at x = 2
    window = upright(0.5, 2.0, 0.5)
    assert one.flux.sum() < solid_angle(lamp.place, first) - 1e-3
    again = two.bounces == 2
    assert abs(two.flux[~again].sum() - one.flux.sum()) < 1e-9
    way = two.positions[two.triangles[again]] - (2.0, 0.0, 4.0)
    expected = 4.0 / np.linalg.norm(way, axis=2)**3
    assert np.median(np.abs(two.irradiance[again] / expected - 1.0)) < 1e-3
    assert np.abs(two.direction[again] - way / np.linalg.norm(way, axis=2, keepdims=True)).max() < 1e-9
    assert two.flux[again].sum() <= solid_angle((-1.0, 0.0, 4.0), window) + 1e-9
    # a wall that the light of the first mirror meets throws nothing on
    walled = caustics(lamp, first, floor, Settings(depth=2), second, upright(5.0, 1.0, 1.0))
    assert walled.flux[walled.bounces == 1].sum() < one.flux.sum() - 1e-3
    assert abs(walled.flux[walled.bounces == 2].sum() - two.flux[again].sum()) < 1e-9


def test_far_from_the_origin_nothing_changes():
    away = np.array((3e5, -2e5, 1e5))
    lamp, mirror, floor = Lamp((1.0, 0.0, 3.0)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0)
    here, there = caustics(lamp, mirror, floor), caustics(
        Lamp(lamp.place + away), *(TriangleMesh(mesh.positions + away, mesh.triangles) for mesh in (mirror, floor)))
    assert abs(here.flux.sum() - there.flux.sum()) < 1e-8
    assert np.abs(np.ptp(here.positions, axis=0) - np.ptp(there.positions, axis=0)).max() < 1e-6
    assert np.abs(there.positions.min(axis=0) - away - here.positions.min(axis=0)).max() < 1e-6


def test_what_cannot_be_is_told_in_one_sentence():
    mirror, floor = upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0)
    with pytest.raises(ReflectionError, match="throws none"):
        caustics(Lamp((1.0, 0.0, 3.0)), mirror, level(0.0, 0.0, 9.0, 1.0))
    with pytest.raises(NothingInView, match="no face with an area"):
        caustics(Lamp((0.0, 0.0, 4.0)), TriangleMesh(np.ones((3, 3)), np.array([[0, 1, 2]])), floor)
    with pytest.raises(ReflectionError, match="lies on the mirror"):
        caustics(Lamp((0.0, 0.1, 1.5)), mirror, floor)
    with pytest.raises(ReflectionError, match="must be a Lamp"):
        caustics((1.0, 0.0, 3.0), mirror, floor)
    with pytest.raises(ValueError, match="must not be zero"):
        Lamp.shining((0.0, 0.0, 0.0))


@pytest.mark.thorough
@pytest.mark.parametrize("width", [1e-6, 0.01, 0.05])
def test_a_cone_of_light_within_one_triangle_has_its_flux(width):
    """A spot in the middle of a large flat mirror: its solid angle, half of that of its blend."""
    axis, half = np.array([-1.0, 0.0, -1.0]) / np.sqrt(2.0), np.cos(0.15)

    def pattern(places: np.ndarray) -> np.ndarray:
        way = places - (2.0, 0.3, 4.0)
        t = np.clip((way @ axis / np.linalg.norm(way, axis=-1) - half) / width, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)
    corners = np.array([(0.0, -60.0, -15.0), (0.0, 61.0, -16.0), (0.0, 2.0, 70.0)])
    mirror = TriangleMesh(corners, np.array([[0, 1, 2]]))
    floor = TriangleMesh(np.array([(-50.0, -90.0, 0.0), (90.0, -95.0, 0.0), (3.0, 99.0, 0.0)]), np.array([[0, 1, 2]]))
    mesh = caustics(Lamp((2.0, 0.3, 4.0), pattern=pattern, narrow=0.07), mirror, floor)
    expected = 2.0 * np.pi * (0.5 * min(width, 1.0 - half) + max(1.0 - half - width, 0.0))
    if width > 1.0 - half:
        top = (1.0 - half) / width
        expected = 2.0 * np.pi * width * (top**3 - 0.5 * top**4)
    assert abs(mesh.flux.sum() / expected - 1.0) < 2e-3
    # as from the lamp behind the mirror, where it is brightest
    places = mesh.positions[mesh.triangles].reshape(-1, 3)
    way = places - (-2.0, 0.3, 4.0)
    shown = pattern(places * (-1.0, 1.0, 1.0)) * 4.0 / np.linalg.norm(way, axis=1)**3
    bright = shown > 0.5 * shown.max()
    # but for the rim of a cone without a blend
    assert bright.sum() > 50 and np.median(np.abs(mesh.irradiance.ravel()[bright] / shown[bright] - 1.0)) < 0.01
