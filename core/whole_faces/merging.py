"""Vertex clustering: if the picture cannot resolve a node's vertices, the nearest to its centre represents them all.

The tree of vertices is descended by the images of its nodes' centres, as for points, so that the work is bounded by the
picture and not by the scene. A triangle is drawn between the representatives of its corners; it is dropped if two of
these are the same (J. Rossignac, P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993).
Vertices only move together, so that no cracks open. Nodes with an outline in them are merged in smaller parts. Nodes
that would lose their surface, such as wires and leaves, are not merged, nor are disconnected parts, such as cloth and
skin.
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, areal, columns, cross, dot, doubled_areas, groups, mask, norm, rows
from ..patches import Descent, Patch, Walk
from ..support import TOGETHER_AT_OUTLINES, breathe, portions
from ..trees import SceneTree
from .images import Images

AT_ONCE = 16384  # triangles whose arrays fit the cache
LEFT = 0.6  # share of a surface's area: if less remains, merging has lost details and not only smoothed them


@dataclass(frozen=True)
class Merged:
    """A scene in which vertices of small parts have been merged into representative vertices.

    Attributes
    ----------
    images : Images, of the scene's vertices; vertices that others represent have none
    triangles : (m, 3) int64, the scene's triangles, with the representatives of their corners
    left : (k,) int64, increasing, triangles that still have an area, one of several in the same place
    """

    images: Images
    triangles: np.ndarray
    left: np.ndarray

    @classmethod
    def of(cls, patch: Patch, tree: SceneTree, least: float, clear: np.ndarray) -> Merged:
        """Merge the vertices of tree nodes whose images on the patch are smaller than `least` pixels.

        Vertices of triangles that are `clear` (m,), which let light through, are not merged: both their sides are seen.
        """
        mesh = tree.mesh
        points = rows(mesh.positions) - patch.eye
        descent = Descent(Walk(patch), tree.vertices, least, tree.bodies.part)
        images = _images(patch, descent, points)
        standing = _in_one_place(mesh, descent.standing)
        own = np.arange(len(standing))
        if (standing == own).all():
            return cls(images, mesh.triangles, np.flatnonzero(mesh.areal))
        descent.fall_apart(_on_outline(tree, images, standing), TOGETHER_AT_OUTLINES * least)
        now = _in_one_place(mesh, descent.standing)
        descent.fall_apart(_lost(mesh, now) | mask(len(own), now[mesh.triangles[clear]].ravel()), 0.0)
        alone = _in_one_place(mesh, descent.standing)
        new = np.flatnonzero((alone == own) & (standing != own))
        near = standing[new]
        images.put(new, Images.near(patch, columns(points, new), images.member[near], columns(images.uv, near),
                                    images.distance[near]))
        standing = alone
        triangles = columns(standing, mesh.triangles)
        corner = columns(mask(len(own), standing[standing != own]), triangles.T)
        asked = np.flatnonzero((corner[0] | corner[1] | corner[2]) & mesh.areal)
        breathe()
        left = mesh.areal.copy()
        left[asked] = _distinct(mesh, images, triangles[asked])
        return cls(images, triangles, np.flatnonzero(left))


def _images(patch: Patch, descent: Descent, points: np.ndarray) -> Images:
    """Compute the images of the `points` (3, v) that represent themselves, starting from those of their nodes."""
    count = points.shape[1]
    member, uv, s = np.zeros(count, dtype=np.int64), np.zeros((2, count)), np.zeros(count)
    found, asked = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    for some in descent.vertices():
        vertex = some.vertex
        asked[vertex] = True
        member[vertex], uv[:, vertex], s[vertex], found[vertex] = descent.walk.images(
            columns(points, vertex), some.nodes, some.node)
    images = Images.at(patch, points, member, uv, s, found)
    lost = np.flatnonzero(asked & ~images.found)
    far = columns(points, lost)
    images.put(lost, Images.at(patch, far, *descent.walk.afresh(far)))
    return images


def _in_one_place(mesh: TriangleMesh, standing: np.ndarray) -> np.ndarray:
    """Return the representative (v,) of each vertex, the same for vertices in one place if any were merged."""
    if (standing == np.arange(len(standing))).all():
        return standing
    return standing[mesh.places]


def _on_outline(tree: SceneTree, images: Images, standing: np.ndarray) -> np.ndarray:
    """Return True for vertices (v,) that represent a part of the scene with an outline in it.

    These represent vertices at which the surface ends, or triangles of which some are seen from the front and some from
    behind. `standing` (v,) is the representative of each vertex.
    """
    mesh = tree.mesh
    found, back = np.zeros((2, len(standing)), dtype=bool)
    for corner, node in _moved(mesh, standing):
        a, b, c = (mesh.positions.take(of_all, axis=0).T for of_all in corner)
        normal = cross(b - a, c - a)
        for stands in node:
            # the triangles that one vertex represents are all seen from the place of its image
            height = dot(normal, columns(images.point, stands) - columns(images.place, stands))
            found[stands[height < 0.0]] = True
            back[stands[height > 0.0]] = True
    found &= back
    found[standing[tree.bodies.border]] = True
    return found


def _lost(mesh: TriangleMesh, standing: np.ndarray) -> np.ndarray:
    """Return True for vertices (v,) whose triangles keep less than `LEFT` of their area when merged.

    `standing` (v,) is the representative of each vertex.
    """
    before, after = np.zeros((2, len(standing)))
    for corner, node in _moved(mesh, standing):
        for total, ends in ((before, corner), (after, node)):
            a, b, c = (mesh.positions.take(of_all, axis=0).T for of_all in ends)
            area = norm(cross(b - a, c - a))
            for stands in node:
                np.add.at(total, stands, area)
    return after < LEFT * before


def _moved(mesh: TriangleMesh, standing: np.ndarray) -> Generator[tuple[np.ndarray, np.ndarray], None, None]:
    """Yield corners (3, n) of triangles with a merged corner, and the representatives (3, n) of these corners."""
    for part in portions(len(mesh.triangles), AT_ONCE):
        corner = mesh.triangles[part].T
        node = columns(standing, corner)
        some = np.flatnonzero((node != corner).any(axis=0))
        yield corner[:, some], node[:, some]


def _distinct(mesh: TriangleMesh, images: Images, triangles: np.ndarray) -> np.ndarray:
    """Return True for triangles (n, 3) that have an area; of several between the same vertices only for one.

    That one is seen from the front if any of them is.
    """
    a, b, c = triangles.T
    kept = np.flatnonzero((a != b) & (b != c) & (c != a))
    kept = kept[areal(rows(mesh.positions.take(triangles[kept].T, axis=0)))]
    # a mirror reverses the orientation of triangles
    front = doubled_areas(images.pixel[:, triangles[kept]].transpose(1, 2, 0)) < 0.0
    kept = np.concatenate((kept[front], kept[~front]))
    first, _ = groups(*np.sort(triangles[kept], axis=1).T)
    return mask(len(triangles), kept[first])
