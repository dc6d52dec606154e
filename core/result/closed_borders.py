"""Borders between faces that lie side by side and show one surface going on, closed: such faces share vertices.

What is drawn whole, what cameras cut and what rays show is worked out part by part. Two parts may have a vertex each in
one place of the picture, or one of them a vertex on a side of the other. No pixel tells that, but who draws lines takes
such sides for the end of the surface.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import (
    TriangleMesh,
    area_normals,
    distinct,
    dot,
    doubled_areas,
    edge_lengths,
    following,
    groups,
    in_order,
    norm,
    ranges,
    rows,
    shared_edges,
)
from ..support import breathe
from ..views import View
from .near_sides import beside, lengths
from .reflection_mesh import ReflectionMesh

SAME = 0.004  # pixels: vertices that are no farther apart are in one place
SHIFTS = SAME * np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)])
ONWARD = 0.75  # pixels: between faces that show points farther apart than they move them by this the surface ends
CREASE = np.cos(np.radians(40.0))  # of the angle between surfaces that meet in a line, as wherever lines are told
THIN = 5e-4  # pixels: parts of faces are wider, which single precision does not turn over
TINY = 1e-9  # pixels: no face is told to be smaller
MOST = 32  # of the vertices in one place: where more lie, as at the tip of a fan, not each is compared with each
ROUNDS = 3  # of splitting faces, each along one of its sides
OF_FACES = ("source_weights", "source_face", "mirror_face", "bounces")
OF_VERTICES = ("positions", "reflected_position", "mirror_position", "path_length", "image_parity", "mirror_normals")


def with_borders_closed(mesh: ReflectionMesh, view: View, scene: TriangleMesh, owner: np.ndarray) -> ReflectionMesh:
    """A result with faces that share vertices wherever what they show goes on from one to the other.

    Parameters
    ----------
    mesh : ReflectionMesh
        With faces.
    view : View
        The eye that it was made for.
    scene : TriangleMesh
        What was reflected.
    owner : (s,) int
        Which object each of its triangles is of: between two there is a line.

    Returns
    -------
    ReflectionMesh
        Vertices that others stand for are left out, and faces with a vertex of another on a side are split.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, reflect, with_borders_closed
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> mesh = reflect(view, mirror, scene)
    >>> closed = with_borders_closed(mesh, view, scene, np.zeros(1, dtype=int))
    >>> len(closed.triangles) == len(mesh.triangles)  # all of it hangs together as it is
    True
    """
    shown = _Shown(view.pixels(mesh.positions), scene, owner)
    closed = _with_same_joined(mesh, shown)
    for _ in range(ROUNDS):
        split = _split(closed, shown)
        if split is closed:
            break
        closed = split
    if closed is mesh:
        return mesh
    # of two faces on the same vertices, as slivers that closed a gap are then, one is enough
    once, _ = groups(*np.sort(closed.triangles, axis=1).T)
    once.sort()
    closed = replace(closed, triangles=closed.triangles[once], **_faces(closed, once))
    kept, corners = distinct(closed.triangles.ravel())
    breathe()
    return replace(closed, triangles=corners.reshape(-1, 3), **{
        name: getattr(closed, name)[kept] for name in OF_VERTICES if getattr(closed, name) is not None})


@dataclass(frozen=True)
class _Shown:
    """Where vertices (n) are in the picture, `pixels` (n, 2), and what was reflected."""

    pixels: np.ndarray
    scene: TriangleMesh
    owner: np.ndarray

    def goes_on(self, mesh: ReflectionMesh, faces: tuple, ends: tuple) -> np.ndarray:
        """Whether one surface goes on from one of two faces (k,) each to the other, where a vertex (k,) of the one lies
        on a side of the other, from a start to an end."""
        one, other = (mesh.source_face[face] for face in faces)
        bounces = mesh.bounces
        assert bounces is not None  # every mesh has them
        found = (self.owner[one] == self.owner[other]) & (bounces[faces[0]] == bounces[faces[1]])
        some = np.flatnonzero(found)
        point, start, end = (mesh.reflected_position[vertex[some]].T for vertex in ends)
        way = end - start
        share = np.clip(dot(point - start, way) / np.maximum(dot(way, way), 1e-300), 0.0, 1.0)
        breathe()
        apart = norm(start + share * way - point)
        close = apart <= ONWARD * np.maximum(*(self._motion(mesh, face[some]) for face in faces))
        some = some[close]
        one, other = (area_normals(rows(self.scene.positions[self.scene.triangles[source[some]]].swapaxes(0, 1)))
                      for source in (one, other))
        found[:] = False
        found[some] = dot(one, other) >= CREASE * norm(one) * norm(other)
        return found

    def _motion(self, mesh: ReflectionMesh, face: np.ndarray) -> np.ndarray:
        """By how much the points that faces (k,) show are apart, for each pixel."""
        once, which = distinct(face)
        corners = mesh.triangles[once]
        return (edge_lengths(mesh.reflected_position[corners]).max(axis=1)
                / np.maximum(edge_lengths(self.pixels[corners]).max(axis=1), TINY))[which]


@dataclass(frozen=True)
class _Borders:
    """Sides (b) that one face alone has: which side of which `face` it is, and from which vertex to which it goes."""

    face: np.ndarray
    side: np.ndarray
    start: np.ndarray
    end: np.ndarray

    @classmethod
    def of(cls, triangles: np.ndarray, pixels: np.ndarray) -> _Borders:
        """Those of `triangles` (m, 3) that have a place in the picture."""
        _, first, edge = shared_edges(triangles)
        first = first[np.bincount(edge.ravel(), minlength=len(first)) == 1]
        breathe()
        face, side = np.divmod(first, 3)
        start, end = triangles.ravel()[first], triangles[face, (side + 1) % 3]
        known = np.isfinite(pixels[start]).all(axis=1) & np.isfinite(pixels[end]).all(axis=1)
        return cls(face[known], side[known], start[known], end[known])

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of the borders, each with every face that it ends a side of."""
        vertex, face = np.concatenate((self.start, self.end)), np.concatenate((self.face, self.face))
        first, _ = groups(vertex, face)
        return vertex[first], face[first]


def _with_same_joined(mesh: ReflectionMesh, shown: _Shown) -> ReflectionMesh:
    """The result with one vertex for those that lie in one place."""
    vertex, face = _Borders.of(mesh.triangles, shown.pixels).ends()
    pairs = [_in_one_place(shown.pixels[vertex] + shift) for shift in SHIFTS]
    one, other = np.concatenate(pairs, axis=1)
    new = np.flatnonzero(vertex[one] != vertex[other])
    once, _ = groups(one[new], other[new])
    one, other = one[new[once]], other[new[once]]
    goes_on = shown.goes_on(mesh, (face[one], face[other]), (vertex[one], vertex[other], vertex[other]))
    one, other = vertex[one[goes_on]], vertex[other[goes_on]]
    if not len(one):
        return mesh
    stands = np.arange(len(mesh.positions))
    while (stands[one] != stands[other]).any():
        low = np.minimum(stands[one], stands[other])
        for end in (one, other):
            np.minimum.at(stands, stands[end], low)
        stands = stands[stands]
    triangles = stands[mesh.triangles]
    kept = np.flatnonzero((triangles != following(triangles)).all(axis=1))
    joined = replace(mesh, triangles=triangles[kept], **_faces(mesh, kept))
    # slivers may be turned over by that, and are turned back
    pixels = shown.pixels
    turned = doubled_areas(pixels[joined.triangles]) * doubled_areas(pixels[mesh.triangles[kept]]) < 0.0
    for part in (joined.triangles, joined.source_weights):
        part[turned] = part[turned][:, [0, 2, 1]]
    return joined


def _in_one_place(spots: np.ndarray) -> np.ndarray:
    """Pairs (2, k) of spots (n, 2) in the same cell of a grid that is as fine as places are told apart."""
    cell = np.floor(spots / SAME).astype(np.int64)
    _, place = groups(*(cell - cell.min(axis=0, initial=0)).T)
    order = in_order(place)
    count = np.bincount(place)
    # each with those behind it in its place
    rank = np.arange(len(spots))
    behind = np.minimum(np.cumsum(count)[place[order]] - rank - 1, MOST)
    other, run = ranges(rank + 1, behind)
    breathe()
    return np.stack((order[run], order[other]))


def _faces(mesh: ReflectionMesh, face: np.ndarray) -> dict:
    return {name: getattr(mesh, name)[face] for name in OF_FACES}


def _split(mesh: ReflectionMesh, shown: _Shown) -> ReflectionMesh:
    """The result with faces split at the vertices that lie on one of their sides; itself where there are none, or where
    parts would have no width."""
    parent, side, vertex = _on_sides(mesh, shown)
    if not len(parent):
        return mesh
    new = np.diff(parent, prepend=-1) != 0
    first, count = np.flatnonzero(new), np.diff(np.append(np.flatnonzero(new), len(parent)))
    parent, side = parent[first], side[first]
    corners = mesh.triangles[parent[:, None], (side[:, None] + np.arange(3)) % 3]
    # from the side's start to each of the vertices, and on to its end: a part of the face each
    part, run = ranges(np.zeros(len(first), dtype=np.int64), count + 1)
    before = np.where(part == 0, corners[run, 0], vertex[np.maximum(first[run] + part - 1, 0)])
    after = np.where(part == count[run], corners[run, 1], vertex[np.minimum(first[run] + part, len(vertex) - 1)])
    triangles = np.column_stack((before, after, corners[run, 2]))
    spots = shown.pixels[triangles]
    height = np.sign(doubled_areas(shown.pixels[corners]))[run] * doubled_areas(spots) / edge_lengths(spots).max(axis=1)
    right = np.bincount(run[~(height > THIN)], minlength=len(first)) == 0
    if not right.any():
        return mesh
    run, triangles = run[right[run]], triangles[right[run]]
    rest = np.ones(len(mesh.triangles), dtype=bool)
    rest[parent[right]] = False
    kept = np.concatenate((np.flatnonzero(rest), parent[run]))
    order = in_order(kept)
    arrays = _faces(mesh, kept[order])
    arrays["source_weights"] = np.concatenate(
        (mesh.source_weights[rest], _weights(mesh, parent[run], side[run], triangles)))[order]
    return replace(mesh, triangles=np.concatenate((mesh.triangles[rest], triangles))[order], **arrays)


def _on_sides(mesh: ReflectionMesh, shown: _Shown) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Faces (k,), in order, one side of each, and the vertices that lie on it, from its start to its end: of borders of
    other faces, which show the surface going on."""
    borders, pixels = _Borders.of(mesh.triangles, shown.pixels), shown.pixels
    vertex, holder = borders.ends()
    row, line, along = beside(pixels[vertex], pixels[borders.start], pixels[borders.end])
    length = lengths(pixels[borders.end[line]] - pixels[borders.start[line]])
    vertex, holder, face, start, end = (part for part in (vertex[row], holder[row], borders.face[line],
                                                          borders.start[line], borders.end[line]))
    inner = np.flatnonzero((along > SAME) & (along < length - SAME)
                           & (mesh.triangles[face] != vertex[:, None]).all(axis=1))
    vertex, holder, face, start, end, along = (part[inner] for part in (vertex, holder, face, start, end, along))
    on = np.flatnonzero(shown.goes_on(mesh, (holder, face), (vertex, start, end)))
    vertex, face, side, along = vertex[on], face[on], borders.side[line[inner[on]]], along[on]
    order = np.lexsort((vertex, along, side, face))
    vertex, face, side = vertex[order], face[order], side[order]
    new = np.diff(face, prepend=-1) != 0
    # of each face the side of its first vertex, and no vertex twice
    own = (side == side[new][np.cumsum(new) - 1]) & (new | (np.diff(vertex, prepend=-1) != 0))
    return face[own], side[own], vertex[own]


def _weights(mesh: ReflectionMesh, parent: np.ndarray, side: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (k, 3, 3) of the corners of parts of faces, in the source triangles of these; their first
    two corners lie on a side."""
    start, end = mesh.triangles[parent, side], mesh.triangles[parent, (side + 1) % 3]
    own = mesh.source_weights[parent[:, None], (side[:, None] + np.arange(3)) % 3]
    origin = mesh.reflected_position[start].T
    way = mesh.reflected_position[end].T - origin
    found = own.copy()
    for corner in (0, 1):
        offset = mesh.reflected_position[triangles[:, corner]].T - origin
        share = np.clip(dot(offset, way) / np.maximum(dot(way, way), 1e-300), 0.0, 1.0)[:, None]
        found[:, corner] = own[:, 0] * (1.0 - share) + own[:, 1] * share
    return found
