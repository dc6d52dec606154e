"""Subdivide faces until values that are linear in an image, such as UV maps, are also nearly linear on the faces."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import bmesh
import numpy as np

from ..faults import Steps

STRAYING = 0.1  # largest deviation in pixels, or in texels where a pixel has several
ROUNDS = 12     # rounds of halving edges; each reduces the error to a quarter
WRITING = "Writing"


def halve_edges(mesh: bpy.types.Mesh, straying: Callable[[], np.ndarray]) -> Steps[None]:
    """Halve the edges that `straying` returns, as indices (n,), until it returns none."""
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
    """Return the indices of edges that deviate by more than `STRAYING`. The deviation is the distance between the
    middle of the ends at `spots` (n, 2), in pixels or texels, and the perspective image of the edge's middle, with the
    vertices at `depth` (n,).
    """
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
