"""One result on the way: its faces stay, and its vertices follow what moves."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core import FollowedImages, ReflectionMesh, TriangleMesh, View
from ..freshness import COARSE
from ..writing import vertices_written

ATTRIBUTES = ("reflected_position", "mirror_position", "path_length")


@dataclass(frozen=True)
class Track:
    """A result as it was written last, and what its vertices show.

    Attributes
    ----------
    result, mirror : int
        `session_uid` of the objects: what has a name may be renamed, and what is pointed to may go.
    placement : str
    origin : (3,) float64
        From where the positions of the mesh are told.
    images : core.FollowedImages
        Of its vertices.
    triangles : (int, int)
        How many the mirror and the scene have.
    """

    result: int
    mirror: int
    placement: str
    origin: np.ndarray
    images: FollowedImages
    triangles: tuple[int, int]

    @classmethod
    def of(cls, obj: bpy.types.Object, result: ReflectionMesh, placement: str, view: View, mirror: TriangleMesh,
           scene: TriangleMesh) -> Track | None:
        """The way of a result that was written just now; None where it cannot be followed: it shows mirrors in mirrors,
        or points."""
        if result.discs is not None or (result.bounces > 1).any():
            return None
        result, origin = vertices_written(result, mirror, view)
        if len(result.positions) != len(obj.data.vertices):
            return None
        images = FollowedImages.of(view, mirror, result)
        return cls(obj.session_uid, obj.reflection_mesh.mirror.session_uid, placement, origin, images,
                   (len(mirror.triangles), len(scene.triangles)))

    def fits(self, obj: bpy.types.Object | None, mirror: TriangleMesh, scene: TriangleMesh) -> bool:
        """Whether the result is still the one that was written, and what it shows has not changed but for its place."""
        return (obj is not None and len(obj.data.vertices) == self.images.source.size
                and (len(mirror.triangles), len(scene.triangles)) == self.triangles)

    def moved(self, obj: bpy.types.Object, view: View, mirror: TriangleMesh, scene: TriangleMesh) -> Track:
        """The result where the view sees it now, written."""
        now = self.images.seen(view, mirror, scene, self.placement)
        mesh = obj.data
        _write(mesh, "position", now.positions - self.origin)
        for name in ATTRIBUTES:
            _write(mesh, name, getattr(now, name))
        obj.reflection_mesh.made_from = COARSE
        mesh.update()
        return replace(self, images=now.images)


def _write(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.domain == "POINT" and len(attribute.data) == len(values):
        field = "vector" if attribute.data_type == "FLOAT_VECTOR" else "value"
        attribute.data.foreach_set(field, values.astype(np.float32).reshape(-1))
