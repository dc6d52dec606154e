"""Billboard impostors: every diffuse object as a flat picture of itself, which the reflected rays meet.

A billboard goes through the middle of its object. An object that is flat lies in its own plane; any other one faces the
mirror, and its picture is what the mirror's centre sees of it. Texels show a triangle and the point on it, or nothing.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, connected, dot
from ..views import View
from .environment import centre_of
from .primary_hits import PrimaryHits
from .rival_picture import NOTHING, RivalPicture, Work
from .textures import Texture, looked_up, texture_of

FLAT = 0.02  # thickness over extent below which an object lies in its own plane
MARGIN = 1.02  # size of a billboard's picture relative to its object
NEAR = 2.0  # radii: pictures of objects nearer to the mirror's centre are orthographic, to avoid huge fields of view


@dataclass(frozen=True)
class Billboard:
    """A picture that stands in space.

    Attributes
    ----------
    centre, normal : (3,) float64
    sight : View
        The eye that took the picture; its rays meet the billboard's plane where the texels stand.
    texture : Texture
    """

    centre: np.ndarray
    normal: np.ndarray
    sight: View
    texture: Texture


def billboarded(view: View, mirror: TriangleMesh, scene: TriangleMesh, side: int, hits: PrimaryHits,
                objects: np.ndarray | None = None) -> RivalPicture:
    """Meet the reflected rays with billboards of `side` x `side` texels.

    Parameters
    ----------
    objects : (t,) int64, optional
        The object of each of the scene's triangles; its connected parts where omitted.
    """
    work = Work()
    objects = connected_parts(scene) if objects is None else objects
    centre = centre_of(mirror)
    billboards = []
    for name in np.unique(objects):
        chosen = np.flatnonzero(objects == name)
        billboards += _billboard(scene, chosen, centre, side)
        work.count(projections=len(np.unique(scene.triangles[chosen])))
    work.done("pictures")
    count = len(hits.pixel)
    nearest, triangle, position = np.full(count, np.inf), np.full(count, NOTHING), np.zeros((3, count))
    for billboard in billboards:
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = dot(billboard.normal, billboard.centre[:, None] - hits.place) / dot(billboard.normal, hits.ray)
        ray = np.flatnonzero((distance > 0.0) & (distance < nearest))
        point = (hits.place[:, ray] + distance[ray] * hits.ray[:, ray]).T
        pixels = billboard.sight.pixels(point)
        ahead = billboard.sight.orthographic | (billboard.sight.depths(point) > 0.0)
        held = ahead & ((pixels >= 0.0) & (pixels <= billboard.sight.resolution)).all(axis=1)
        ray = ray[held]
        found, where = looked_up(billboard.texture, pixels[held])
        shown = found >= 0
        nearest[ray[shown]], triangle[ray[shown]] = distance[ray[shown]], found[shown]
        position[:, ray[shown]] = where[:, shown]
    work.count(rays=count, intersections=count * len(billboards), lookups=count * len(billboards))
    work.done("rays")
    return work.picture(view.resolution, hits.pixel, triangle, position)


def connected_parts(mesh: TriangleMesh) -> np.ndarray:
    """(t,) int64: triangles that hang together by shared places have the same number."""
    _, welded = np.unique(mesh.positions, axis=0, return_inverse=True)
    return connected(welded.reshape(-1)[mesh.triangles])


def _billboard(scene: TriangleMesh, chosen: np.ndarray, viewer: np.ndarray, side: int) -> list[Billboard]:
    points = scene.positions[np.unique(scene.triangles[chosen])]
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    _, extent, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    if len(extent) < 3 or extent[1] <= 0.0:
        return []
    flat = extent[2] <= FLAT * extent[1]
    away = np.linalg.norm(viewer - centre)
    normal = axes[2] if flat or away == 0.0 else (viewer - centre) / away
    normal = normal if normal @ (viewer - centre) >= 0.0 else -normal
    radius = np.linalg.norm(points - centre, axis=1).max()
    # the longest axis that does not point at the viewer
    up = axes[0] if np.abs(axes[0] @ normal) < 0.9 else axes[1]
    if not flat and away > NEAR * radius:
        angles = np.abs(_angles(points, viewer, centre, up)).max()
        sight = View.looking_at(viewer, centre, (side, side), field_of_view=2.0 * np.arctan(MARGIN * np.tan(angles)),
                                up=up)
    else:
        # the object's own axes lie along the picture's, so that a flat rectangle fills it
        across = np.cross(up - (up @ normal) * normal, normal)
        across /= np.linalg.norm(across)
        offset = points - centre
        width = 2.0 * MARGIN * max(np.abs(offset @ across).max(), np.abs(offset @ np.cross(normal, across)).max())
        sight = View.looking_at(centre + 2.0 * radius * normal, centre, (side, side), orthographic_scale=width, up=up)
    return [Billboard(centre, normal, sight, texture_of(sight, scene, chosen))]


def _angles(points: np.ndarray, viewer: np.ndarray, centre: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Angles (2, n) of points off the line from `viewer` to `centre`, sideways and upwards."""
    sight = View.looking_at(viewer, centre, (2, 2), field_of_view=0.5 * np.pi, up=up)
    return np.arctan(sight.pixels(points).T - 1.0)
