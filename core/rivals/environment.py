"""Environment mapping: a panorama taken at the mirror's centre, looked up by the reflected ray's direction.

J. Blinn, M. Newell, "Texture and reflection in computer generated images", CACM 1976; as a cube of six pictures after
N. Greene, "Environment mapping and other applications of world projections", IEEE CG&A 1986. Right for a scene that is
infinitely far away. With `boxed`, what is looked up is the direction from the centre to where the ray leaves the
scene's box, as parallax volumes of real-time engines do: right for a scene that is its own box.
"""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh
from ..views import View
from .primary_hits import PrimaryHits
from .rival_picture import RivalPicture, Work
from .textures import Texture, looked_up, texture_of

BORDER = 1  # texels of each picture beyond its side of the cube, so that no seam shows


def mapped(view: View, mirror: TriangleMesh, scene: TriangleMesh, side: int, hits: PrimaryHits) -> RivalPicture:
    """Look up the reflected directions in a panorama of six pictures of `side` x `side` texels."""
    work = Work()
    return _lookup(view, (mirror, scene), side, hits, hits.ray, work)


def boxed(view: View, mirror: TriangleMesh, scene: TriangleMesh, side: int, hits: PrimaryHits) -> RivalPicture:
    """The same with the directions to where the rays leave the box around the scene."""
    work = Work()
    used = scene.positions[scene.triangles.ravel()]
    low, high = used.min(axis=0)[:, None], used.max(axis=0)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.maximum((low - hits.place) / hits.ray, (high - hits.place) / hits.ray)
    leave = np.nanmin(ends, axis=0)
    target = hits.place + np.maximum(leave, 0.0) * hits.ray
    # a ray that starts outside the box and looks away from it sees nothing of the scene whatever its parallax
    directions = np.where(leave > 0.0, target - centre_of(mirror)[:, None], hits.ray)
    return _lookup(view, (mirror, scene), side, hits, directions, work)


def centre_of(mirror: TriangleMesh) -> np.ndarray:
    """Middle of the box around the mirror, where its panorama is taken."""
    used = mirror.positions[mirror.triangles.ravel()]
    return 0.5 * (used.min(axis=0) + used.max(axis=0))


def panorama(centre: np.ndarray, scene: TriangleMesh, side: int) -> list[tuple[View, Texture]]:
    """Views from `centre` along +X, -X, +Y, -Y, +Z and -Z, and what they see."""
    wide = 2.0 * np.arctan((side + 2.0 * BORDER) / side)
    views = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            ahead, up = np.zeros(3), np.zeros(3)
            ahead[axis], up[(axis + 2) % 3] = sign, 1.0
            views.append(View.looking_at(centre, centre + ahead, (side + 2 * BORDER,) * 2, field_of_view=wide, up=up))
    return [(sight, texture_of(sight, scene)) for sight in views]


def _lookup(view, meshes, side, hits, directions, work) -> RivalPicture:
    mirror, scene = meshes
    centre = centre_of(mirror)
    pictures = panorama(centre, scene, side)
    work.count(projections=6 * len(np.unique(scene.triangles)))
    work.done("panorama")
    axis = np.argmax(np.abs(directions), axis=0)
    ahead = np.take_along_axis(directions, axis[None], axis=0)[0]
    face = 2 * axis + (ahead < 0.0)
    triangle, position = np.empty(len(face), dtype=np.int64), np.empty((3, len(face)))
    for number, (sight, texture) in enumerate(pictures):
        ray = np.flatnonzero(face == number)
        # any point along the direction will do: the pictures are taken at the centre
        pixels = sight.pixels((centre[:, None] + directions[:, ray] / np.abs(ahead[ray])).T)
        triangle[ray], position[:, ray] = looked_up(texture, pixels)
    work.count(rays=len(face), lookups=len(face))
    work.done("look-up")
    return work.picture(view.resolution, hits.pixel, triangle, position)
