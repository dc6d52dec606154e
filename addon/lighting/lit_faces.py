"""The faces of reflections, and the light path of each of their corners."""
from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np

from ...core import View
from ...core.result import place
from ..reading import corner_vertices, numbers, vectors
from ..reading.materials import is_displaced
from ..writing import ARRIVAL, NORMAL
from .world_faces import WORLD, lies_on_mirror

GROUPS = 1 << 30     # more than a reflection has groups of faces
MOST_BOUNCES = 1 << 8


@dataclass(frozen=True)
class Faces:
    """The faces of a reflection in world space: corners are of triangles (m, 3).

    Attributes
    ----------
    positions : (n, 3) float64, where the mesh lies
    images : (n, 3) float64, which hide each other as the faces do, before and behind the same pixels
    corners : (m, 3) int64, vertices of each face
    targets, origins : (m, 3, 3) float64, ends of the light path of each corner
    sky : (m,) bool, faces that show the world
    displaced : (m,) bool, faces of which renders move the source: it is looked for from the mirror on
    normals : (m, 3, 3) float64, of the mirror at the corners; zero after several mirrors
    group : (m,) int64, the same for faces of one mirror that show one source by as many mirrors
    turn : (m,) float32, as of `LightPaths`
    """

    positions: np.ndarray
    images: np.ndarray
    corners: np.ndarray
    targets: np.ndarray
    origins: np.ndarray
    sky: np.ndarray
    displaced: np.ndarray
    normals: np.ndarray
    group: np.ndarray
    turn: np.ndarray

    @classmethod
    def joined(cls, parts: list[Faces]) -> Faces:
        """Return the faces of all parts as one."""
        parts = [cls.none(), *parts]
        starts = np.cumsum([0, *(len(one.positions) for one in parts)])
        corners = np.concatenate([one.corners + start for one, start in zip(parts, starts)])
        others = {name: np.concatenate([getattr(one, name) for one in parts])
                  for name in ("positions", "images", "targets", "origins", "sky", "displaced", "normals", "group",
                               "turn")}
        return cls(corners=corners, **others)

    @classmethod
    def none(cls) -> Faces:
        none, ends = np.zeros((0, 3)), np.zeros((0, 3, 3))
        return cls(none, none, none.astype(np.int64), ends, ends, *np.zeros((2, 0), dtype=bool), ends,
                   np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.float32))


class Placed(NamedTuple):
    """A reflection that is to be lit.

    Attributes
    ----------
    mesh : bpy.types.Mesh
    matrix : (4, 4) float64, places the mesh where it was generated
    layered : bool, True if faces that others hide need light of their own
    mirror : int, the same for copies of one reflection, which share their place in the picture of light
    turns : for each source, the angle in radians by which it may be seen from elsewhere and look the same
    """

    mesh: bpy.types.Mesh
    matrix: np.ndarray
    layered: bool
    mirror: int
    turns: tuple[float, ...]

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) float64, in world space."""
        return vectors(self.mesh, "position") @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    @property
    def has_faces(self) -> bool:
        return len(self.mesh.polygons) > 0


def faces_of(placed: Placed, view: View) -> Faces:
    """Read the faces of a reflection that `view` sees, and the light path of each corner."""
    mesh = placed.mesh
    corners = corner_vertices(mesh).astype(np.int64)
    target, origin = vectors(mesh, "reflected_position")[corners], vectors(mesh, "mirror_position")[corners]
    source, normals = numbers(mesh, "source_object").astype(np.int64), vectors(mesh, NORMAL)[corners]
    group = placed.mirror * GROUPS + (source - WORLD) * MOST_BOUNCES
    if ARRIVAL in mesh.attributes:
        # light that met several mirrors arrives from the last one
        later = numbers(mesh, "bounces") > 1
        origin[later] = target[later] - vectors(mesh, ARRIVAL)[corners[later]]
        normals[later] = 0.0
        group += numbers(mesh, "bounces")
    positions = images = placed.positions
    if lies_on_mirror(mesh, positions):
        # all in one plane: what they show tells which is before another
        images = place(view, vectors(mesh, "mirror_position").T, numbers(mesh, "path_length"), "VIRTUAL").T
    sky, displaced = source == WORLD, np.array([is_displaced(one) for one in mesh.materials] or [False])
    slot = np.zeros(len(corners), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", slot)
    displaced = displaced[np.minimum(slot, len(displaced) - 1)] & ~sky
    # the last one is that of the world; where renders move the source its points are not known
    turn = np.array((*placed.turns, 0.0), dtype=np.float32)[source] * ~displaced
    return Faces(positions, images, corners, target, origin, sky, displaced, normals, group, turn)
