"""One result on the way: its faces stay, and its vertices follow what moves."""
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
    """Objects that show one result, without anything of Blender's, which may go.

    Attributes
    ----------
    results : tuple of int
        `session_uid` of the result and of its copies: what has a name may be renamed, and what is pointed to may go.
    vertices : tuple of int
        How many each has.
    mirror : int
        The same of the mirror.
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
    """A result as it was written last, and what its vertices show.

    Attributes
    ----------
    shown : Written
        What shows it.
    origin : (3,) float64
        From where the positions of the mesh are told.
    images : core.FollowedImages
        Of its vertices.
    triangles : (int, int)
        How many the mirror and the scene have.
    """

    shown: Written
    origin: np.ndarray
    images: FollowedImages
    triangles: tuple[int, int]

    @property
    def mirror(self) -> int:
        """The mirror's `session_uid`."""
        return self.shown.mirror

    @classmethod
    def of(cls, shown: Written, result: ReflectionMesh, view: View, mirror: TriangleMesh, scene: TriangleMesh
           ) -> Track | None:
        """The way of a result that was written just now; None where it cannot be followed: it shows mirrors in mirrors,
        or points. Works on arrays alone."""
        if result.discs is not None or (result.bounces > 1).any():
            return None
        result, origin = vertices_written(result, mirror, view)
        if any(len(result.positions) != count for count in shown.vertices):
            return None
        images = FollowedImages.of(view, mirror, result)
        return cls(shown, origin, images, (len(mirror.triangles), len(scene.triangles)))

    def fits(self, objects: dict, mirror: TriangleMesh, scene: TriangleMesh) -> bool:
        """Whether the results, by their `session_uid`, are still those that were written, and what they show has not
        changed but for its place."""
        results = [objects.get(uid) for uid in self.shown.results]
        return (all(obj is not None and len(obj.data.vertices) == self.images.source.size
                    and applied_to(obj) == Matrix.Identity(4) for obj in results)
                and (len(mirror.triangles), len(scene.triangles)) == self.triangles)

    def seen(self, view: View, mirror: TriangleMesh, scene: TriangleMesh) -> Followed:
        """Where the view sees the vertices now; works on arrays alone."""
        return self.images.seen(view, mirror, scene, self.shown.placement)

    def written(self, objects: dict, now: Followed) -> Track:
        """The results, by their `session_uid` among `objects`, with their vertices where these are seen now."""
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
