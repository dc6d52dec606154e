"""What mirrors hide with their own bodies: under the foot of one that stands on a floor, and within it, no light comes,
and no mirror shows what is there, wherever the camera is."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import TriangleMesh, View, breathe
from ...core.geometry import area_normals, unit
from ...core.trees import BoxTree, first_hits
from ..reading import corner_vertices, join_scene, mirrors_of, numbers, read_meshes, vectors

NEAR = 1e-5     # of what mirrors measure: what comes nearer touches
ASKED = 1024    # faces of a result that tell which side of its mirror reflects
ONE_SIDE = 0.99  # of them, from which on it is one side
RISES = ((90.0, 1), (45.0, 6), (1.5, 8))  # degrees above a surface, and how many ways around


@dataclass(frozen=True)
class MirrorBodies:
    """The mirrors of results.

    Attributes
    ----------
    tree : BoxTree
        Of their triangles (m), faces that do not reflect among them.
    outwards : (3, m) float64
        Normals on the side that reflects; nothing where both do.
    """

    tree: BoxTree
    outwards: np.ndarray

    def near(self, corners: np.ndarray) -> np.ndarray:
        """Whether shapes with corners (n, k, 3) may be hidden in places, (n,) bool."""
        if not len(self.tree):
            return np.zeros(len(corners), dtype=bool)
        low, high = (side[:, 0] + self.tree.middle for side in (self.tree.low, self.tree.high))
        room = NEAR * self.tree.size
        return ((corners.min(axis=1) <= high + room) & (corners.max(axis=1) >= low - room)).all(axis=1)

    def hide(self, places: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Whether, from places (n, 3) of surfaces, on the side of their unit normals (n, 3), mirrors touch, or show
        nothing but their backs, whichever way one looks, (n,) bool."""
        room = NEAR * self.tree.size
        below, above = (places + step * normals for step in (-room, room))
        met = first_hits(self.tree, below.T, normals.T, limit=np.full(len(places), 2.0 * room)).triangle
        # what touches from the other side has its back here
        hidden = (met >= 0) & (np.einsum("in,ni->n", self.outwards[:, met], normals) < 0.0)
        left = np.flatnonzero(~hidden)
        for way in _ways():
            ahead = np.matmul(_frames(normals[left]), way).T
            met = first_hits(self.tree, above[left].T, ahead).triangle
            left = left[(met >= 0) & (np.einsum("in,in->n", self.outwards[:, met], ahead) > 0.0)]
            breathe()
        hidden[left] = True
        return hidden


def mirror_bodies(context: bpy.types.Context, results: list, view: View) -> MirrorBodies:
    """The mirrors of `results`, that `view` sees."""
    mirrors = list(dict.fromkeys(mirror for result in results for mirror in mirrors_of(result)))
    placed = read_meshes(context.evaluated_depsgraph_get(), mirrors, mirror=True)
    if not placed:
        nothing = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
        return MirrorBodies(BoxTree.build(nothing), np.zeros((3, 0)))
    scene = join_scene(placed, mirrors)
    tree = BoxTree.build(scene.mesh)
    normals = unit(area_normals(scene.mesh.positions[scene.mesh.triangles].transpose(2, 1, 0)))
    seen = np.zeros((len(mirrors), 2))
    for result in results:
        mesh = result.data
        corners = corner_vertices(mesh)[numbers(mesh, "bounces") == 1]
        some = corners[::max(len(corners) // ASKED, 1)]
        origins, ahead = view.rays(view.pixels(vectors(mesh, "mirror_position")[some].mean(axis=1)))
        triangle = first_hits(tree, origins.T, ahead.T).triangle
        fronts = np.einsum("in,in->n", normals[:, triangle], ahead.T) < 0.0
        np.add.at(seen, (scene.source_object[triangle[triangle >= 0]], fronts[triangle >= 0].astype(np.int64)), 1.0)
    share = seen[:, 1] / np.maximum(seen.sum(axis=1), 1.0)
    side = np.where(share >= ONE_SIDE, 1.0, np.where((share <= 1.0 - ONE_SIDE) & (seen[:, 0] > 0.0), -1.0, 0.0))
    return MirrorBodies(tree, normals * side[scene.source_object])


def _ways() -> np.ndarray:
    """Unit vectors (n, 3) above a surface whose normal is z; straight up first, by which most places look out."""
    ways = []
    for rise, count in RISES:
        turn, up = 2.0 * np.pi * np.arange(count) / count, np.radians(rise)
        ways.append(np.column_stack((np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.full(count, np.sin(up)))))
    return np.concatenate(ways)


def _frames(normals: np.ndarray) -> np.ndarray:
    """Rotations (n, 3, 3) that turn z to each of the normals (n, 3)."""
    side = np.where((np.abs(normals[:, 2]) < 0.9)[:, None], (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    along = np.cross(side, normals)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack((along, np.cross(normals, along), normals), axis=2)
