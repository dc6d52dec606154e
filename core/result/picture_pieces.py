"""Anamorphosis: the pieces of the diffuse scene that a mirror shows, each with its place in the picture.

Every face of a reflection mesh is a piece of one triangle of the scene, seen at known places. A map that is linear on
such pieces tells for each point of the scene where the eye sees it: what is painted by that map looks right in the
mirror. (J. L. Hunt, B. G. Nickel, C. Gigault, *Anamorphic images*, American Journal of Physics 68, 2000, have it in
closed form for cylinders and cones.)
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, connected, distinct, doubled_areas, edge_lengths, following, numbered, split
from ..support import breathe, portions
from ..views import View
from .hidden_images import FrontImages
from .piece_location import holders
from .reflection_mesh import ReflectionMesh

STRAYING = 0.1
"""Pixels that a linear map may be wrong by inside a piece, beside what the reflection itself is."""
FINEST = 2.0
"""Pixels: shorter edges are not halved where something nearer hides a piece in part."""
ROUNDS = 12
"""Of halving edges: what a map is wrong by falls to a quarter by each."""
AT_ONCE = 1 << 15  # pieces


@dataclass(frozen=True)
class PicturePieces(ColumnArrays):
    """Pieces of the triangles of a diffuse scene, with their places in the picture of the mirror.

    Attributes
    ----------
    face : (k,) int64
        Triangle of the scene that each piece lies in.
    weights : (k, 3, 3) float64
        Barycentric coordinates of the piece's corners in it.
    pixels : (k, 3, 2) float64
        Images of the corners, in pixels from the picture's lower left corner, right and up.
    image : (k,) int64
        Number of the image that the piece belongs to. An image is connected and has one parity; 0 is the largest in the
        picture, and hidden pieces have higher numbers than all visible ones. A point that is seen several times lies
        in pieces of several images.

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

    counting_axis = 0
    face: np.ndarray
    weights: np.ndarray
    pixels: np.ndarray
    image: np.ndarray

    def holding(self, face: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Find the piece (n,) of the largest image that contains each point of the scene; -1 if there is none.

        Of two pieces of one image that contain a point, the one is taken that is more magnified in the picture: places
        on a triangle that is seen edge on are imprecise.

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
        point, piece = holders(self.face, self.weights, face, weights)
        with np.errstate(divide="ignore", invalid="ignore"):
            enlarged = np.nan_to_num(np.abs(np.linalg.det(self.pixels[:, 1:] - self.pixels[:, :1])
                                            / np.linalg.det(self.weights)))[piece]
        order = np.lexsort((-enlarged, self.image[piece], point))
        first = order[np.unique(point[order], return_index=True)[1]]
        found[point[first]] = piece[first]
        return found


def picture_pieces(view: View, mesh: ReflectionMesh, straying: float = STRAYING) -> PicturePieces:
    """Split the faces of `mesh` into pieces small enough for their places in the picture to be linear on them.

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
    breathe()
    clip = view.clip(mesh.positions)[mesh.triangles]
    breathe()
    kept = np.flatnonzero(_in_picture(_pixels(clip, view), view))
    clip, weights = clip[kept], mesh.source_weights[kept]
    breathe()
    front = FrontImages.of(view, mesh, image)
    for _ in range(ROUNDS):
        pixels = _pixels(clip, view)
        hidden = front.hidden(kept, pixels)
        partly = hidden.any(axis=1) & ~hidden.all(axis=1)
        marked = np.zeros((len(clip), 3), dtype=bool)
        for own in portions(len(clip), AT_ONCE):
            marked[own] = _straying(clip[own, :, 3], pixels[own]) > straying
            marked[own] |= partly[own, None] & (edge_lengths(pixels[own]) > FINEST)
        if not marked.any():
            break
        parent, local = split(marked)
        clip, kept = _children(clip, parent, local), kept[parent]
        weights = _children(weights, parent, local)
    pixels = _pixels(clip, view)
    behind = front.hidden(kept, pixels)[:, 0]
    rank = image[kept] + behind * (int(image.max(initial=0)) + 1)
    return PicturePieces(mesh.source_face[kept], weights, pixels, rank)


def _images(view: View, mesh: ReflectionMesh) -> np.ndarray:
    """Number the connected images of one parity, the largest first; return the number (m,) for each face."""
    parity = np.sign(mesh.image_parity[mesh.triangles].sum(axis=1, dtype=np.int64))
    # separate vertices by parity: images of opposite parity meet in vertices on their caustic
    _, vertex = distinct((mesh.triangles * 3 + (parity[:, None] + 1)).ravel())
    part = connected(vertex.reshape(-1, 3))
    breathe()
    area = np.abs(doubled_areas(view.pixels(mesh.positions)[mesh.triangles]))
    breathe()
    of_parts = np.bincount(part, np.where(np.isfinite(area), area, 0.0))
    return numbered(len(of_parts), np.argsort(-of_parts, kind="stable"))[part]


def _in_picture(pixels: np.ndarray, view: View) -> np.ndarray:
    """Return True for triangles with corners at `pixels` (k, 3, 2) that may reach into the picture.

    Triangles with a corner behind the eye have no finite pixels and are outside.
    """
    return (np.isfinite(pixels).all(axis=(1, 2)) & (pixels.max(axis=1) > 0.0).all(axis=1)
            & (pixels.min(axis=1) < view.resolution).all(axis=1))


def _pixels(clip: np.ndarray, view: View) -> np.ndarray:
    """Convert clip coordinates (..., 4) to pixels (..., 2); NaN for points that are not before the eye."""
    found = np.empty((*clip.shape[:-1], 2))
    for part in portions(len(clip), AT_ONCE):
        depth = np.where(clip[part, ..., 3:] > 0.0, clip[part, ..., 3:], np.nan)
        found[part] = (clip[part, ..., :2] / depth * 0.5 + 0.5) * view.resolution
    return found


def _straying(depth: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Return the error (k, 3), in pixels, of linear interpolation at the middles of the edges 01, 12, 20 of triangles.

    It is the distance between the image of an edge's middle and the middle of the edge's image, for triangles with
    corners at `pixels` (k, 3, 2) and depths `depth` (k, 3).
    """
    other = following(depth)
    return 0.5 * np.abs(other - depth) / (other + depth) * edge_lengths(pixels)


def _children(corners: np.ndarray, parent: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Interpolate values at `corners` (k, 3, c) of triangles to the corners of their parts.

    Parameters
    ----------
    parent : (n,) int64, triangle of each part
    local : (n, 3) int64, its corners: 0 to 2 for the triangle's corners, 3 to 5 for the middles of its edges
    """
    found = np.empty((*local.shape, corners.shape[2]))
    for part in portions(len(parent), AT_ONCE):
        own = corners[parent[part]]
        six = np.concatenate((own, 0.5 * (own + following(own))), axis=1)
        found[part] = np.take_along_axis(six, local[part, :, None], axis=1)
    return found
