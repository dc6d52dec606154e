"""Splitting of faces at vertices of other faces of the same surface that lie on their sides (T-junctions)."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import dot, doubled_areas, edge_lengths, in_order, mask, next_corner, ranges
from ..result import ReflectionMesh
from .borders import Borders
from .joined_places import SAME
from .near_sides import beside, lengths
from .surfaces import Surfaces

THIN = 5e-4  # pixels: smallest height of the parts of a split face, so that single precision does not flip them


def with_sides_split(mesh: ReflectionMesh, surfaces: Surfaces,
                     among: np.ndarray) -> tuple[ReflectionMesh, np.ndarray]:
    """Split faces at vertices of other faces of the same surface that lie on one of their sides.

    Only borders count: sides that belong to one face, and the vertices at their ends. A vertex lies on a side if it is
    at most 0.05 pixels beside it in the picture, and more than 0.004 pixels from both ends (`BESIDE` in `near_sides`,
    `SAME`). Each face is split along one side only. It stays unsplit if a part would be flipped, or at most `THIN`
    (0.0005) pixels high.

    Parameters
    ----------
    mesh : ReflectionMesh, with m faces
    surfaces : Surfaces
        Positions of the mesh's vertices in the picture, and the test whether two faces show one continuous surface.
    among : (m,) bool, faces that may be split

    Returns
    -------
    mesh : ReflectionMesh, with the same vertices and k faces
    waiting : (k,) bool
        Faces of the new mesh that may have to be split again: parts, and faces that a thin part left unsplit. All False
        if no face was split.
    """
    parent, side, vertex = _on_sides(mesh, surfaces, among)
    new = np.diff(parent, prepend=-1) != 0
    first, count = np.flatnonzero(new), np.diff(np.append(np.flatnonzero(new), len(parent)))
    parent, side = parent[first], side[first]
    corners = mesh.triangles[parent[:, None], (side[:, None] + np.arange(3)) % 3]
    # make one part for each piece of the side, from its start over the vertices to its end
    part, run = ranges(np.zeros(len(first), dtype=np.int64), count + 1)
    before = np.where(part == 0, corners[run, 0], vertex[np.maximum(first[run] + part - 1, 0)])
    after = np.where(part == count[run], corners[run, 1], vertex[np.minimum(first[run] + part, len(vertex) - 1)])
    triangles = np.column_stack((before, after, corners[run, 2]))
    spots = surfaces.pixels[triangles]
    turned = np.sign(doubled_areas(surfaces.pixels[corners]))[run]
    height = turned * doubled_areas(spots) / edge_lengths(spots).max(axis=1)
    right = np.bincount(run[~(height > THIN)], minlength=len(first)) == 0
    if not right.any():
        return mesh, np.zeros_like(among)
    run, triangles = run[right[run]], triangles[right[run]]
    rest = ~mask(len(mesh.triangles), parent[right])
    kept = np.concatenate((np.flatnonzero(rest), parent[run]))
    order = in_order(kept)
    arrays = mesh.of_faces(kept[order])
    arrays["source_weights"] = np.concatenate(
        (mesh.source_weights[rest], _weights(mesh, parent[run], side[run], triangles)))[order]
    # faces not split now may still have vertices on another side
    again = mask(len(mesh.triangles), parent[~right])
    waiting = np.concatenate((again[rest], np.ones(len(run), dtype=bool)))
    split = replace(mesh, triangles=np.concatenate((mesh.triangles[rest], triangles))[order], **arrays)
    return split, waiting[order]


def _on_sides(mesh: ReflectionMesh, surfaces: Surfaces, among: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find faces with vertices on a side.

    The vertices are ends of borders of other faces that continue the same surface. For each face, one side is returned.

    Parameters
    ----------
    among : (m,) bool, faces to test

    Returns
    -------
    face : (k,) int64, rising, one entry for each vertex
    side : (k,) int64, number of the side in the face
    vertex : (k,) int64, vertices in order from the side's start to its end
    """
    borders, pixels = Borders.of(mesh.triangles, surfaces.pixels), surfaces.pixels
    vertex, holder = borders.ends()
    borders = borders.select(among[borders.face])
    row, line, along = beside(pixels[vertex], pixels[borders.start], pixels[borders.end])
    length = lengths(pixels[borders.end] - pixels[borders.start])
    inner = np.flatnonzero((along > SAME) & (along < length[line] - SAME))
    row, line, along = row[inner], line[inner], along[inner]
    inner = np.flatnonzero((mesh.triangles[borders.face[line]] != vertex[row, None]).all(axis=1))
    row, line, along = row[inner], line[inner], along[inner]
    vertex, holder, face, side = vertex[row], holder[row], borders.face[line], borders.side[line]
    on = np.flatnonzero(surfaces.goes_on(mesh, (holder, face), (vertex, borders.start[line], borders.end[line])))
    vertex, face, side, along = vertex[on], face[on], side[on], along[on]
    order = np.lexsort((vertex, along, side, face))
    vertex, face, side = vertex[order], face[order], side[order]
    new = np.diff(face, prepend=-1) != 0
    # keep for each face the side of its first vertex, and drop duplicate vertices
    own = (side == side[new][np.cumsum(new) - 1]) & (new | (np.diff(vertex, prepend=-1) != 0))
    return face[own], side[own], vertex[own]


def _weights(mesh: ReflectionMesh, parent: np.ndarray, side: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return barycentric coordinates (k, 3, 3) of the corners of parts of faces in their source triangles.

    Parameters
    ----------
    parent, side : (k,) int64, face that each part lies in, and its side that is split
    triangles : (k, 3) int64, vertices of the parts; the first two lie on the side
    """
    start, end = mesh.triangles[parent, side], mesh.triangles[parent, next_corner(side)]
    own = mesh.source_weights[parent[:, None], (side[:, None] + np.arange(3)) % 3]
    origin = mesh.reflected_position[start].T
    way = mesh.reflected_position[end].T - origin
    found = own.copy()
    for corner in (0, 1):
        offset = mesh.reflected_position[triangles[:, corner]].T - origin
        share = np.clip(dot(offset, way) / np.maximum(dot(way, way), 1e-300), 0.0, 1.0)[:, None]
        found[:, corner] = own[:, 0] * (1.0 - share) + own[:, 1] * share
    return found
