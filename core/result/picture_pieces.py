"""Anamorphosis: the pieces of the diffuse scene that a mirror shows, each with its place in the picture.

Every face of a reflection mesh is a piece of one triangle of the scene, seen at known places. A map that is linear on
such pieces tells for each point of the scene where the eye sees it: what is painted by that map looks right in the
mirror. (J. L. Hunt, B. G. Nickel, C. Gigault, *Anamorphic images*, American Journal of Physics 68, 2000, have it in
closed form for cylinders and cones.)
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import View, connected, doubled_areas, following, ranges, split
from .reflection_mesh import ReflectionMesh

STRAYING = 0.1
"""Pixels that a linear map may be wrong by inside a piece, beside what the reflection itself is."""
TOUCHING = 1e-9
"""Of a barycentric coordinate: what a point on an edge may be off by."""
ROUNDS = 12
"""Of halving edges: what a map is wrong by falls to a quarter by each."""


@dataclass(frozen=True)
class PicturePieces:
    """Pieces of the triangles of a diffuse scene, and where the eye sees them in the mirror.

    Attributes
    ----------
    face : (k,) int64
        Triangle of the scene that each piece lies in.
    weights : (k, 3, 3) float64
        Barycentric coordinates of the piece's corners in it.
    pixels : (k, 3, 2) float64
        Where the eye sees the corners, in pixels from the picture's lower left corner, right and up.
    image : (k,) int64
        Which image the piece belongs to: one that hangs together and is nowhere turned over, 0 the largest in the
        picture. A point that is seen several times lies in pieces of several images.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, picture_pieces, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> pieces = picture_pieces(view, reflect(view, mirror, scene))
    >>> np.abs(np.linalg.det(pieces.weights)).sum().round(6).item()  # all of the triangle is seen
    1.0
    """

    face: np.ndarray
    weights: np.ndarray
    pixels: np.ndarray
    image: np.ndarray

    def select(self, chosen: np.ndarray) -> PicturePieces:
        """Some of the pieces, by index or mask."""
        return PicturePieces(self.face[chosen], self.weights[chosen], self.pixels[chosen], self.image[chosen])

    def holding(self, face: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Piece (n,) of the largest image that holds points of the scene; -1 where none does.

        A triangle that is seen edge on is known badly there: of two pieces of one image that hold a point, that counts
        whose part of the triangle is larger in the picture.

        Parameters
        ----------
        face : (n,) int64
            The triangle that each point lies in.
        weights : (n, 3) float64
            Its barycentric coordinates there.
        """
        found = np.full(len(face), -1)
        if not len(self.face):
            return found
        point, piece = _near(self.face, self.weights[:, :, 1:], face, weights[:, 1:])
        shares = np.linalg.solve(np.swapaxes(_regular(self.weights[piece]), 1, 2), weights[point, :, None])[..., 0]
        held = (shares >= -TOUCHING).all(axis=1)
        point, piece = point[held], piece[held]
        with np.errstate(divide="ignore", invalid="ignore"):
            enlarged = np.nan_to_num(np.abs(np.linalg.det(self.pixels[piece, 1:] - self.pixels[piece, :1])
                                            / np.linalg.det(self.weights[piece])))
        order = np.lexsort((-enlarged, self.image[piece], point))
        first = order[np.unique(point[order], return_index=True)[1]]
        found[point[first]] = piece[first]
        return found


def picture_pieces(view: View, mesh: ReflectionMesh, straying: float = STRAYING) -> PicturePieces:
    """The pieces of the scene that `mesh` shows, small enough for their places in the picture to be linear on them.

    Parameters
    ----------
    view : View
        The eye that the mesh was made for.
    mesh : ReflectionMesh
        With faces. What lies outside the picture is left out.
    straying : float
        Pixels that a linear map may be wrong by, against the mesh as it is drawn.

    Returns
    -------
    PicturePieces

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, picture_pieces, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> pieces = picture_pieces(view, reflect(view, mirror, scene))
    >>> corner = np.argmax(pieces.weights[:, :, 2])  # the highest point: seen as far below the mirror
    >>> np.allclose(pieces.pixels.reshape(-1, 2)[corner], view.pixels(np.array([[0, 0, -1.4]])), atol=0.1)
    True
    """
    image = _images(view, mesh)
    clip = view.clip(mesh.positions)[mesh.triangles]
    kept = np.flatnonzero(_in_picture(_pixels(clip, view), view))
    clip, weights = clip[kept], mesh.source_weights[kept]
    for _ in range(ROUNDS):
        marked = _straying(clip, view) > straying
        if not marked.any():
            break
        parent, local = split(marked)
        clip, weights, kept = _children(clip, parent, local), _children(weights, parent, local), kept[parent]
    return PicturePieces(mesh.source_face[kept], weights, _pixels(clip, view), image[kept])


def _images(view: View, mesh: ReflectionMesh) -> np.ndarray:
    """The image (m,) that each face belongs to, the largest first."""
    parity = np.sign(mesh.image_parity[mesh.triangles].sum(axis=1, dtype=np.int64))
    # images that are turned over against each other meet in vertices on their caustic
    _, vertex = np.unique(mesh.triangles * 3 + (parity[:, None] + 1), return_inverse=True)
    part = connected(vertex.reshape(-1, 3))
    area = np.abs(doubled_areas(view.pixels(mesh.positions)[mesh.triangles]))
    of_parts = np.bincount(part, np.where(np.isfinite(area), area, 0.0))
    rank = np.empty(len(of_parts), dtype=np.int64)
    rank[np.argsort(-of_parts, kind="stable")] = np.arange(len(of_parts))
    return rank[part]


def _in_picture(pixels: np.ndarray, view: View) -> np.ndarray:
    """Which triangles (k,) the picture may show; those that are on both sides of the eye have no place in it."""
    return (np.isfinite(pixels).all(axis=(1, 2)) & (pixels.max(axis=1) > 0.0).all(axis=1)
            & (pixels.min(axis=1) < view.resolution).all(axis=1))


def _pixels(clip: np.ndarray, view: View) -> np.ndarray:
    """Places (..., 2) in the picture of homogeneous ones (..., 4), none of what is not before the eye."""
    depth = np.where(clip[..., 3:] > 0.0, clip[..., 3:], np.nan)
    return (clip[..., :2] / depth * 0.5 + 0.5) * view.resolution


def _straying(clip: np.ndarray, view: View) -> np.ndarray:
    """Pixels (k, 3) between the middles of the edges 01, 12, 20 as they are seen and those of their pictures."""
    pixels, depth = _pixels(clip, view), clip[..., 3]
    length = np.linalg.norm(following(pixels) - pixels, axis=2)
    other = following(depth)
    return 0.5 * np.abs(other - depth) / (other + depth) * length


def _children(corners: np.ndarray, parent: np.ndarray, local: np.ndarray) -> np.ndarray:
    """What the corners of the parts of triangles have, from what (k, 3, c) those of the triangles have."""
    middles = 0.5 * (corners + following(corners))
    return np.take_along_axis(np.concatenate((corners, middles), axis=1)[parent], local[:, :, None], axis=1)


def _regular(weights: np.ndarray) -> np.ndarray:
    """Weights (k, 3, 3) of pieces' corners, those of pieces without an area such that no point lies within."""
    flat = np.abs(np.linalg.det(weights)) < 1e-18
    return np.where(flat[:, None, None], -np.eye(3), weights)


def _near(owner: np.ndarray, corners: np.ndarray, face: np.ndarray, points: np.ndarray) -> tuple:
    """Pairs of points (n, 2) and pieces with `corners` (k, 3, 2) of the same triangle, `face` and `owner`, among them
    all in which the piece holds the point: each triangle has a grid of about as many cells as it has pieces."""
    _, both = np.unique(np.concatenate((owner, face)), return_inverse=True)
    owner, face = both[:len(owner)], both[len(owner):]
    number = np.bincount(owner, minlength=int(both.max()) + 1)
    across = np.ceil(np.sqrt(number)).astype(np.int64)
    start = np.cumsum(across**2) - across**2

    def cell(of: np.ndarray, place: np.ndarray) -> np.ndarray:
        return np.clip((place * across[of, None]).astype(np.int64), 0, np.maximum(across[of, None] - 1, 0))
    low, high = cell(owner, corners.min(axis=1)), cell(owner, corners.max(axis=1))
    size = high - low + 1
    step, piece = ranges(np.zeros(len(owner), dtype=np.int64), size.prod(axis=1))
    column, row = low[piece, 0] + step % size[piece, 0], low[piece, 1] + step // size[piece, 0]
    held_by = start[owner[piece]] + row * across[owner[piece]] + column
    order = np.argsort(held_by, kind="stable")
    asked = np.flatnonzero(number[face] > 0)
    column, row = cell(face[asked], points[asked]).T
    wanted = start[face[asked]] + row * across[face[asked]] + column
    first, last = (np.searchsorted(held_by[order], wanted, side=side) for side in ("left", "right"))
    entry, point = ranges(first, last - first)
    return asked[point], piece[order[entry]]
