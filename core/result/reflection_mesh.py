"""The result: the reflection as triangles or as points, with where each corner came from and what it cost."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..geometry import dot, following, unit
from ..support import breathe
from ..views import View
from .discs import Discs

ON_SIDE = 1e-6  # barycentric coordinate: a corner that is nearer to a side lies on it
OF_FACES = ("source_face", "source_weights", "mirror_face", "bounces", "map_face", "later_mirrors")
OF_VERTICES = ("positions", "reflected_position", "mirror_position", "path_length", "image_parity", "mirror_normals")


@dataclass(frozen=True)
class ReflectionMesh:
    """The reflection of a diffuse scene in one mirror, in world space and scene units.

    Attributes
    ----------
    positions : (n, 3) float64
        Vertices where the placement puts them.
    triangles : (m, 3) int64
        Faces, turned towards the eye where they show the front of their source, away from it where its back.
    reflected_position : (n, 3) float64
        The diffuse point whose image the vertex is.
    mirror_position : (n, 3) float64
        Q on the mirror.
    path_length : (n,) float64
        From Q to the diffuse point.
    image_parity : (n,) int8
        +1 or -1 (turned over), 0 on a caustic.
    source_face : (m,) int64
        Triangle of the diffuse scene.
    source_weights : (m, 3, 3) float64
        Barycentric coordinates of each corner of each face in its source triangle, none negative: they carry UVs and
        colours over.
    mirror_face : (m,) int64
        Triangle of the mirror, -1 where a face spans several.
    counts : dict
        How much of each part the scene needed, plain integers: cameras, nodes visited, pairs, roots, `joined` polygons
        that hold their whole triangle and `cut` ones, edges that a bound on depth or count left too long (`limited`),
        in how many steps it was the bound on count (`bounded`), cameras that are too small to be cut (`open`), those in
        which so much lies over one another that rays show it as finely (`dense`) or more coarsely than was asked for
        (`crowded`), all of which are `filled` by cells that `rays` tell what to show, `probes` that see a diffuse
        object and those of them that no face shows (`missed`).
    seconds : dict
        Time by stage.
    estimated_error : float
        Estimated 99th percentile of the displacement inside the faces, in pixels, on the safe side; of points the same
        of their discs' longer half axes.
    discs : Discs or None
        For the method POINTS, where there are no faces: radius, source vertex and more of each point.
    bounces : (m,) int8
        How many mirrors the light of each face met: 1 for what is seen in the mirror itself, the default.
    mirror_normals : (n, b, 3) float64 or None
        Unit normal of each mirror that the eye sees a vertex by, the nearest to the eye first, zero for those that it
        is not seen by. None of points.
    maps : tuple of ReflectionMap
        For a lamp's view, the true maps of the first bounce, the second and so on; their numbers are the method's own.
    map_face : (m,) int64 or None
        For a lamp's view, the face of its bounce's map that each face is seen by.
    later_mirrors : (m, b) int64 or None
        The triangles of all mirrors that each face is seen by after the first one, the nearest to the eye first; -1
        where it is seen by no more. None of points.

    Examples
    --------
    >>> import numpy as np
    >>> from core import Settings, TriangleMesh, View, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> mesh = reflect(view, mirror, scene, Settings(placement="VIRTUAL"))
    >>> mesh.positions[:, 2].round(6).min().item()  # as deep behind the mirror as the scene is high
    -1.4
    """

    positions: np.ndarray
    triangles: np.ndarray
    reflected_position: np.ndarray
    mirror_position: np.ndarray
    path_length: np.ndarray
    image_parity: np.ndarray
    source_face: np.ndarray
    source_weights: np.ndarray
    mirror_face: np.ndarray
    counts: dict = field(default_factory=dict)
    seconds: dict = field(default_factory=dict)
    estimated_error: float = 0.0
    discs: Discs | None = None
    bounces: np.ndarray | None = None
    mirror_normals: np.ndarray | None = None
    maps: tuple = ()
    map_face: np.ndarray | None = None
    later_mirrors: np.ndarray | None = None

    def __post_init__(self) -> None:
        if self.bounces is None:
            object.__setattr__(self, "bounces", np.ones(len(self.triangles), dtype=np.int8))

    @property
    def source_sides(self) -> np.ndarray:
        """(m, 3) int8: the side of the source triangle, from corner k to the next, whose image each side of each face
        is a part of; -1 for sides that only cut the image, along a mirror's triangle or what hides it."""
        beside = self.source_weights < ON_SIDE
        opposite, side = beside & following(beside), np.full(beside.shape[:2], -1, dtype=np.int8)
        # side k lies opposite to corner k + 2
        for k in (2, 1, 0):
            side[opposite[:, :, (k + 2) % 3]] = k
        return side

    def image_normals(self, normals: np.ndarray) -> np.ndarray:
        """Normals as the mirrors show them, (m, 3, 3) at the corners of the faces.

        Parameters
        ----------
        normals : (s, 3, 3) float64
            At the corners of the source triangles.

        Returns
        -------
        (m, 3, 3) float64
            Unit normals; zero where those of the source cancel, or where the result has no `mirror_normals`.
        """
        if self.mirror_normals is None:
            return np.zeros(self.triangles.shape + (3,))
        corners = normals[self.source_face]
        breathe()
        shown = np.matmul(self.source_weights, corners)
        for mirror in np.moveaxis(self.mirror_normals, 1, 0)[::-1]:
            breathe()
            across = mirror[self.triangles]
            breathe()
            shown -= 2.0 * np.einsum("fci,fci->fc", shown, across)[:, :, None] * across
        breathe()
        length = np.sqrt(np.einsum("fci,fci->fc", shown, shown))[:, :, None]
        breathe()
        return np.divide(shown, length, out=np.zeros_like(shown), where=length > 0.0)

    def cosines(self, view: View) -> np.ndarray:
        """(n, b) float64: of the angle of incidence at each of the mirrors of `mirror_normals`; 0 where there is none.

        Parameters
        ----------
        view : View
            The eye that the result was made for.
        """
        assert self.mirror_normals is not None  # only results of points have none
        sight, found = unit(view.directions(self.mirror_position).T), []
        for normal in np.moveaxis(self.mirror_normals, (1, 2), (0, 1)):
            breathe()
            level = dot(sight, normal)
            found.append(np.abs(level))
            sight = sight - 2.0 * level * normal
        return np.stack(found, axis=1)

    def of_faces(self, face: np.ndarray) -> dict:
        """Return the attributes of the faces `face` (k,), by name, except `triangles`."""
        return self._chosen(OF_FACES, face)

    def of_vertices(self, vertex: np.ndarray) -> dict:
        """Return the attributes of the vertices `vertex` (k,), by name."""
        return self._chosen(OF_VERTICES, vertex)

    def _chosen(self, names: tuple[str, ...], chosen: np.ndarray) -> dict:
        return {name: getattr(self, name)[chosen] for name in names if getattr(self, name) is not None}

    @property
    def missing_share(self) -> float:
        """Share of what the mirror shows, in %, that probes found missing; 0 where nothing was probed."""
        return 100.0 * self.counts.get("missed", 0) / max(self.counts.get("probes", 0), 1)

    @property
    def filled_share(self) -> float:
        """Share of the mirror's pixels that rays filled, in %."""
        return filled_share(self.counts)


def filled_share(counts: dict[str, int]) -> float:
    """Share of the mirror's pixels that rays filled, in %, as a reflection's counts tell it."""
    # a pixel that rays fill at two bounces counts twice, so limit the share
    return min(100.0, 100.0 * counts.get("filled_pixels", 0) / max(counts.get("mirror_pixels", 0), 1))
