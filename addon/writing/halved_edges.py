"""Faces cut until what is linear in a picture is so on them: UV maps and all else that faces interpolate."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import bmesh
import numpy as np

from ..faults import Steps

STRAYING = 0.1  # pixels, or texels where a pixel has several, by which what is shown may lie beside its place
ROUNDS = 12     # of halving edges: an error falls to a quarter by each
WRITING = "Writing"


def halve_edges(mesh: bpy.types.Mesh, straying: Callable[[], np.ndarray]) -> Steps[None]:
    """Halve the edges that `straying` tells, (n,) of their numbers, until it tells none."""
    for _ in range(ROUNDS):
        edges = straying()
        if not len(edges):
            return
        yield 0.0, WRITING
        cut = bmesh.new()
        try:
            cut.from_mesh(mesh)
            yield 0.0, WRITING
            cut.edges.ensure_lookup_table()
            # each new vertex is joined with the corner across: what is left to be divided into triangles could, where
            # it is thin, have the uncut side again
            bmesh.ops.subdivide_edges(cut, edges=[cut.edges[edge] for edge in edges.tolist()], cuts=1,
                                      use_single_edge=True)
            yield 0.0, WRITING
            bmesh.ops.triangulate(cut, faces=[face for face in cut.faces if len(face.verts) > 3])
            yield 0.0, WRITING
            cut.to_mesh(mesh)
        finally:
            cut.free()


def edges_that_stray(mesh: bpy.types.Mesh, spots: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """The edges whose middle, where what is seen at `spots` (n, 2), in pixels or texels, is divided by a `depth` (n,),
    lies farther than `STRAYING` from the middle of their ends."""
    if not len(mesh.polygons):
        return np.empty(0, dtype=np.int64)
    ends = np.empty((len(mesh.edges), 2), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends.reshape(-1))
    deep, at = depth[ends], spots[ends]
    ahead = (deep > 0.0).all(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        length = np.linalg.norm(at[:, 1] - at[:, 0], axis=1)
        straying = 0.5 * np.abs(deep[:, 1] - deep[:, 0]) / deep.sum(axis=1) * length
    return np.flatnonzero(ahead & (straying > STRAYING))
