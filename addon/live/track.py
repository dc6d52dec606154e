"""One result during movement: its faces stay, and its vertices are updated."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ...core import FollowedImages, ReflectionMesh, TriangleMesh, View
from ...core.following import Followed
from ..freshness import COARSE
from ..writing import applied_to, forget_landmarks, vertices_written

ATTRIBUTES = ("reflected_position", "mirror_position", "path_length")


class Written(NamedTuple):
    """Objects that show one result, without references to Blender's data, which may be removed.

    Attributes
    ----------
    results : tuple of int
        `session_uid` of the result and of its copies. Names and references could become invalid.
    vertices : tuple of int
        Number of vertices of each.
    mirror : int
        `session_uid` of the mirror.
    placement : str
    """

    results: tuple[int, ...]
    vertices: tuple[int, ...]
    mirror: int
    placement: str

    @classmethod
    def of(cls, objects: list, mirror: bpy.types.Object, placement: str) -> Written:
        return cls(tuple(obj.session_uid for obj in objects), tuple(len(obj.data.vertices) for obj in objects),
                   mirror.session_uid, placement)


@dataclass(frozen=True)
class Track:
    """A result as it was written last, with the source points of its vertices.

    Attributes
    ----------
    shown : Written
        Objects that show it.
    origin : (3,) float64
        World position to which the mesh's positions are relative.
    images : core.FollowedImages
        Source points of the vertices.
    triangles : (int, int)
        Number of triangles of the mirror and of the scene.
    """

    shown: Written
    origin: np.ndarray
    images: FollowedImages
    triangles: tuple[int, int]

    @property
    def mirror(self) -> int:
        """`session_uid` of the mirror."""
        return self.shown.mirror

    @classmethod
    def of(cls, shown: Written, result: ReflectionMesh, view: View, mirror: TriangleMesh, scene: TriangleMesh
           ) -> Track | None:
        """Track a result that was just written. Return None if it cannot be tracked because it shows mirrors in
        mirrors, or points. Use arrays only.
        """
        if result.discs is not None or (result.bounces > 1).any():
            return None
        result, origin = vertices_written(result, mirror, view)
        if any(len(result.positions) != count for count in shown.vertices):
            return None
        images = FollowedImages.of(view, mirror, result)
        return cls(shown, origin, images, (len(mirror.triangles), len(scene.triangles)))

    def fits(self, objects: dict, mirror: TriangleMesh, scene: TriangleMesh) -> bool:
        """Return True if the results in `objects` (by `session_uid`) are those that were written, and mirror and scene
        have the same number of triangles.
        """
        results = [objects.get(uid) for uid in self.shown.results]
        return (all(obj is not None and len(obj.data.vertices) == self.images.source.size
                    and applied_to(obj) == Matrix.Identity(4) for obj in results)
                and (len(mirror.triangles), len(scene.triangles)) == self.triangles)

    def seen(self, view: View, mirror: TriangleMesh, scene: TriangleMesh) -> Followed:
        """Compute where the view sees the vertices now. Use arrays only."""
        return self.images.seen(view, mirror, scene, self.shown.placement)

    def written(self, objects: dict, now: Followed) -> Track:
        """Write the positions `now` into the vertices of the results in `objects` (by `session_uid`)."""
        results = [objects[uid] for uid in self.shown.results]
        for mesh in {obj.data for obj in results}:
            _write(mesh, "position", now.positions - self.origin)
            for name in ATTRIBUTES:
                _write(mesh, name, getattr(now, name))
            mesh.update()
        for obj in results:
            obj.reflection_mesh.made_from = COARSE
            forget_landmarks(obj)
        return replace(self, images=now.images)


def _write(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.domain == "POINT" and len(attribute.data) == len(values):
        field = "vector" if attribute.data_type == "FLOAT_VECTOR" else "value"
        attribute.data.foreach_set(field, values.astype(np.float32).reshape(-1))
