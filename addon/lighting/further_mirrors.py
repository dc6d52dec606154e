"""Follow the directions in which mirrors show the world where they meet other mirrors, or the same one again."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ...core import TriangleMesh, View
from ...core.cameras import MirrorSurface
from ...core.geometry import unit
from ...core.trees import BoxTree, first_hits
from ..illumination import MirrorColours
from ..reading import join_mirror, lost_mirror, mirrors_of, read_meshes

NEAR = 1e-6         # of the mirrors' size: so far from a mirror its reflected rays begin
BEFORE = 1e-3       # of the same: so far before the first mirror a path begins


@dataclass(frozen=True)
class FurtherMirrors:
    """All mirrors with reflections of a scene, in which paths to the world may be reflected again.

    Attributes
    ----------
    surface : MirrorSurface
    tree : BoxTree
    colours : MirrorColours
    bounces : int, the most reflections of a path
    """

    surface: MirrorSurface
    tree: BoxTree
    colours: MirrorColours
    bounces: int

    @classmethod
    def of(cls, results: Iterable[bpy.types.Object], lit: Iterable[bpy.types.Object]) -> FurtherMirrors | None:
        """Return the mirrors of `results` that mirrors show; None if there are none, or none of those that are `lit`
        shows mirrors in its mirror."""
        bounces = max(result.reflection_mesh.bounces for result in lit)
        if bounces < 2:
            return None
        depsgraph = bpy.context.evaluated_depsgraph_get()
        mirrors = dict.fromkeys(tuple(part for part in mirrors_of(one) if part.visible_glossy)
                                for one in results if not lost_mirror(one))
        surfaces = [join_mirror(read_meshes(depsgraph, list(parts), mirror=True), list(parts))
                    for parts in mirrors if parts]
        if not surfaces:
            return None
        starts = np.cumsum([0, *(len(one.mesh.positions) for one in surfaces)])
        mesh = TriangleMesh(np.concatenate([one.mesh.positions for one in surfaces]),
                            np.concatenate([one.mesh.triangles + start for one, start in zip(surfaces, starts)]),
                            np.concatenate([one.mesh.corner_normals for one in surfaces]))
        return cls(MirrorSurface(mesh), BoxTree.build(mesh), MirrorColours.of(surfaces), bounces)

    def follow(self, view: View, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Follow the paths that a view sees at places (n, 3) on mirrors to their last mirror.

        Returns
        -------
        later : (k,) int64
            The paths that meet more than one mirror.
        places, directions : (k, 3) float64
            Their places on the last mirror, and their directions from there, as long as the view's.
        left : (k, 3) float64
            What all mirrors but the first leave of the light.
        """
        ray = view.directions(places).T.copy()
        place = places.T - BEFORE * self.tree.size * unit(ray)
        left, later, going = np.ones((len(places), 3)), np.zeros(len(places), dtype=bool), np.arange(len(places))
        for bounce in range(self.bounces):
            hits = first_hits(self.tree, place[:, going], ray[:, going])
            hit = np.flatnonzero(hits.triangle >= 0)
            going, triangle, arriving = going[hit], hits.triangle[hit], ray[:, going[hit]]
            place[:, going] += hits.distance[hit] * arriving
            on = self.surface.coordinates(triangle, place[:, going])
            leaving = self.surface.unbent(triangle, on, arriving)
            self.surface.lift(triangle, on, leaving, arriving)
            if bounce:
                later[going] = True
                cosine = -np.einsum("in,in->n", unit(arriving), self.surface.normals(triangle, on))
                left[going] *= self.colours.left(triangle[:, None], cosine[:, None])
            # the next path begins beside the surface
            ray[:, going], place[:, going] = leaving, place[:, going] + NEAR * self.tree.size * unit(leaving)
        chosen = np.flatnonzero(later)
        return chosen, place[:, chosen].T, ray[:, chosen].T, left[chosen]
