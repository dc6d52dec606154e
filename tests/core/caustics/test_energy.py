"""The light that falls on each face, against the irradiance at many places on it."""
from __future__ import annotations

import importlib
from dataclasses import replace

import numpy as np
import pytest

from core import Lamp, Settings, TriangleMesh, caustics, reflect
from core.caustics.corners import light_at, mean_weight
from core.caustics.energy import balanced, flux_of, on_faces, shown_area
from core.caustics.refinement import refined
from core.geometry import cross, dot, norm
from tests.core.caustics.test_caustics import level, ring

room = importlib.import_module("core.caustics.caustics")  # the function has the room's name
SETTINGS = replace(Settings(), hidden_faces=True, method="GENERAL", placement="SURFACE")
LAMPS = (Lamp((3.0, 0.5, 1.7)), Lamp.shining((-1.0, 0.1, -0.5)))


def faces_of(lamp: Lamp, mirror: TriangleMesh, receiver: TriangleMesh):
    """The faces of the light that a mirror throws, their flux and their map."""
    view, = lamp.views(mirror, None, None, room.DETAIL)
    seen = reflect(view, mirror, receiver, SETTINGS, mirror)
    ray_map, = seen.maps
    faces = room._faces(ray_map, seen, room.without_slivers(seen), receiver, lamp)
    whole = flux_of(view, seen.mirror_position[seen.triangles]).sum()
    reach = np.ptp(seen.reflected_position, axis=0).max()
    faces, _ = refined(ray_map, faces, receiver, lamp, (room.LEAST * whole, room.FINEST * reach), 10**6)
    flux = flux_of(view, np.moveaxis(faces.light.place.reshape(3, 3, -1), 2, 0).swapaxes(1, 2))
    return faces, flux * mean_weight(ray_map, faces.face, faces.light, lamp), ray_map


def asked_all_over(faces, ray_map, inner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The irradiance (k, m) at places with barycentric coordinates `inner` (k, 3) in faces, and whether light comes
    there."""
    uv, light = faces.light.uv.reshape(2, 3, -1), []
    for weights in inner:
        start, point = np.einsum("k,ckm->cm", weights, uv), np.einsum("k,ckm->cm", weights, faces.corners())
        origin, ray = ray_map.leave(faces.face, start)
        s = dot(point - origin, ray) / dot(ray, ray)
        place, _ = ray_map.locate(faces.face, start, s, point, 30)
        light.append(light_at(ray_map, faces.face, place, point, faces.normal, Lamp((0.0, 0.0, 0.0))))
    return np.array([one.irradiance for one in light]), np.array([one.arrived for one in light])


@pytest.mark.thorough
@pytest.mark.parametrize("lamp", LAMPS, ids=("point", "sun"))
def test_a_face_has_the_light_that_falls_on_it_within_its_straight_sides(lamp):
    faces, flux, ray_map = faces_of(lamp, ring(96), level(0.0, 0.0, 0.0, 4.0))
    corners = faces.corners()
    area = 0.5 * norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    # in the middles of equal parts
    steps = 6
    i, j = (one.ravel() for one in np.meshgrid(np.arange(steps), np.arange(steps)))
    up, down = i + j < steps, i + j < steps - 1
    inner = np.concatenate((np.stack((i, j), 1)[up] + 1 / 3, np.stack((i, j), 1)[down] + 2 / 3)) / steps
    found, arrived = asked_all_over(faces, ray_map, np.column_stack((1.0 - inner.sum(axis=1), inner)))
    known = arrived.all(axis=0) & np.isfinite(found).all(axis=0) & (found.max(axis=0) < 2.0 * found.min(axis=0))
    expected = (area * found.mean(axis=0))[known]
    assert expected.sum() > 0.9 * flux.sum()  # the rest lies at folds

    def off(light: np.ndarray) -> float:
        return np.abs(light[known] - expected).sum() / expected.sum()
    told = on_faces(flux, faces.beside, faces.triangles)
    assert off(told) < 0.008 and off(flux) > 0.03
    # and so have the values at its corners
    values = faces.light.irradiance.reshape(3, -1).T
    shown = shown_area(np.moveaxis(faces.corners(), 2, 0).swapaxes(1, 2), area, 8.0)
    shared = balanced(values, told, faces.triangles, shown)
    assert off(area * shared.mean(axis=1)) < 0.008


def test_light_that_falls_beyond_a_side_is_that_of_the_face_across():
    triangles, flux = np.array([[0, 1, 2], [2, 1, 3], [4, 5, 6]]), np.array([4.0, 2.0, 1.0])
    # the second side of the first is the first of the second; the others' light falls on themselves
    beside = np.array([[0.3, 0.5, 0.1], [-0.5, 0.0, 0.2], [0.9, 0.9, 0.9]])
    np.testing.assert_allclose(on_faces(flux, beside, triangles), (3.5, 2.5, 1.0))
    # no face loses more than it has
    beside[:2] *= 100.0
    told = on_faces(flux, beside, triangles)
    assert told.min() > 0.0 and told[0] < 1.0 and abs(told.sum() - flux.sum()) < 1e-12


def test_narrow_faces_keep_their_light_and_others_do_not_get_it():
    width = 1e-4
    corners = np.array([[(0, 0, 0), (8, 0, 0), (8, 8, 0)], [(20, 0, 0), (21, 0, 0), (21, width, 0)]], dtype=float)
    area, flux = np.array([32.0, 0.5 * width]), np.array([1.0, 1.0])
    triangles, even = np.arange(6).reshape(2, 3), np.repeat((flux / area)[:, None], 3, axis=1)
    found = balanced(even, flux, triangles, shown_area(corners, area, 21.0))
    # single precision moves the narrow one's corners by a fortieth of its width
    np.testing.assert_allclose(area * found.mean(axis=1), flux, rtol=2e-3)


@pytest.mark.thorough
def test_light_is_known_where_the_mirror_stands_on_what_it_lights():
    count, step = 24, np.pi / 24
    angle = np.arange(count + 1) * step
    foot = np.stack((np.cos(angle), -np.sin(angle), 0.0 * angle), axis=1)
    positions = np.concatenate((foot, foot + (0.0, 0.0, 1.0)))
    k = np.arange(count)
    triangles = np.concatenate((np.stack((k, k + count + 1, k + 1), 1),
                                np.stack((k + 1, k + count + 1, k + count + 2), 1)))
    # as if it were round over its rims, so that light at the foot is lifted
    normals = positions * (1.0, 1.0, 2.0) - (0.0, 0.0, 1.0)
    mirror = TriangleMesh(positions, triangles, (normals / np.linalg.norm(normals, axis=1)[:, None])[triangles])
    faces, _, _ = faces_of(Lamp.shining((0.2, 1.0, -0.8)), mirror, level(0.0, 0.0, 0.0, 4.0))
    at_foot = np.abs(faces.light.place[2]) < 1e-12
    assert at_foot.sum() > 2 * count and faces.light.arrived[at_foot].all()


@pytest.mark.thorough
def test_light_that_would_take_more_faces_than_there_may_be_says_so():
    """What the mirror shows has room; its light, finer than that, stays as coarse as it is, and whole."""
    free, bounded = (caustics(LAMPS[0], ring(48), level(0.0, 0.0, 0.0, 4.0), Settings(maximum_faces=most))
                     for most in (10**6, 25_000))
    assert bounded.counts["limited"] == free.counts["limited"] and bounded.counts["faces"] == free.counts["faces"]
    assert len(free.triangles) > 25_000 > bounded.counts["faces"]
    assert (free.counts["bounded"], bounded.counts["bounded"]) == (0, 1)
    assert len(bounded.triangles) <= 25_000
    assert abs(bounded.flux.sum() / free.flux.sum() - 1.0) < 1e-6
