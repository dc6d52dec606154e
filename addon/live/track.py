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
    results : tuple of int
        `session_uid` of the result and of its copies: what has a name may be renamed, and what is pointed to may go.
    mirror : int
        The same of the mirror.
    placement : str
    origin : (3,) float64
        From where the positions of the mesh are told.
    images : core.FollowedImages
        Of its vertices.
    triangles : (int, int)
        How many the mirror and the scene have.
    """

    results: tuple[int, ...]
    mirror: int
    placement: str
    origin: np.ndarray
    images: FollowedImages
    triangles: tuple[int, int]

    @classmethod
    def of(cls, written: list, result: ReflectionMesh, placement: str, view: View, mirror: TriangleMesh,
           scene: TriangleMesh) -> Track | None:
        """The way of a result that was written just now, to the objects `written`; None where it cannot be followed: it
        shows mirrors in mirrors, or points."""
        if result.discs is not None or (result.bounces > 1).any():
            return None
        result, origin = vertices_written(result, mirror, view)
        if any(len(result.positions) != len(obj.data.vertices) for obj in written):
            return None
        images = FollowedImages.of(view, mirror, result)
        return cls(tuple(obj.session_uid for obj in written), written[0].reflection_mesh.mirror.session_uid, placement,
                   origin, images, (len(mirror.triangles), len(scene.triangles)))

    def fits(self, objects: dict, mirror: TriangleMesh, scene: TriangleMesh) -> bool:
        """Whether the results, by their `session_uid`, are still those that were written, and what they show has not
        changed but for its place."""
        results = [objects.get(uid) for uid in self.results]
        return (all(obj is not None and len(obj.data.vertices) == self.images.source.size for obj in results)
                and (len(mirror.triangles), len(scene.triangles)) == self.triangles)

    def moved(self, objects: dict, view: View, mirror: TriangleMesh, scene: TriangleMesh) -> Track:
        """The results where the view sees them now, written."""
        now = self.images.seen(view, mirror, scene, self.placement)
        results = [objects[uid] for uid in self.results]
        for mesh in {obj.data for obj in results}:
            _write(mesh, "position", now.positions - self.origin)
            for name in ATTRIBUTES:
                _write(mesh, name, getattr(now, name))
            mesh.update()
        for obj in results:
            obj.reflection_mesh.made_from = COARSE
        return replace(self, images=now.images)


def _write(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.domain == "POINT" and len(attribute.data) == len(values):
        field = "vector" if attribute.data_type == "FLOAT_VECTOR" else "value"
        attribute.data.foreach_set(field, values.astype(np.float32).reshape(-1))
