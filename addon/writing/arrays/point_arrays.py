"""The arrays of a reflection by the method Points: loose points with their discs, and where they came from."""
from __future__ import annotations

import numpy as np

from ....core import ReflectionMesh, View
from ...reading.meshes import DiffuseScene, MirrorSurface
from .attribute import Attribute
from .mesh_arrays import MeshArrays, origin_of, point_attributes, shown_layers

DISC_SCALE = "disc_scale"
"""The attribute with the size of each point's disc along its own axes."""


def point_arrays(result: ReflectionMesh, scene: DiffuseScene, surface: MirrorSurface, view: View) -> MeshArrays:
    """Return the arrays of a result without faces; parameters as for `mesh_arrays`."""
    discs = result.discs
    corner = _corner_of_vertex(scene)[discs.source_vertex]
    source, at = corner // 3, corner % 3
    rotation, scale = _placed_discs(discs.axes, view.directions(result.positions))
    origin = origin_of(surface.mesh)
    own = (
        *point_attributes(result),
        Attribute("radius", "FLOAT", "POINT", discs.radius.astype(np.float32)),
        Attribute("disc_rotation", "QUATERNION", "POINT", rotation.astype(np.float32)),
        Attribute(DISC_SCALE, "FLOAT_VECTOR", "POINT", scale.astype(np.float32)),
        Attribute("source_object", "INT", "POINT", scene.source_object[source].astype(np.int32)),
        Attribute("source_face", "INT", "POINT", scene.source_face[source].astype(np.int32)),
        Attribute("mirror_face", "INT", "POINT", surface.triangle[discs.mirror_face].astype(np.int32)),
        Attribute("source_material", "INT", "POINT", scene.material[source].astype(np.int32)),
    )
    return MeshArrays(origin, (result.positions - origin).astype(np.float32), np.empty((0, 3), np.int32),
                      own + shown_layers(scene, own, "POINT", lambda values: values[source, at]), scene.materials)


def _corner_of_vertex(scene: DiffuseScene) -> np.ndarray:
    """Return for each vertex the first corner of the scene's triangles that has it, as 3 * triangle + corner."""
    triangles = scene.mesh.triangles
    table = np.zeros(len(scene.mesh.positions), dtype=np.int64)
    # the last assignment to an index wins, so assign in reverse order
    table[triangles.ravel()[::-1]] = np.arange(triangles.size)[::-1]
    return table


def _placed_discs(axes: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return quaternions (n, 4) that rotate X and Y to the half axes (n, 2, 3) and Z towards the eye, and scales (n, 3)
    with the lengths of the half axes.
    """
    length = np.linalg.norm(axes, axis=2)
    x, y = np.moveaxis(axes / np.maximum(length, 1e-300)[:, :, None], 1, 0)
    y = np.where((np.cross(x, y) * directions).sum(axis=1, keepdims=True) > 0.0, -y, y)
    m = np.stack((x, y, np.cross(x, y)), axis=2)
    # 4 q q' by the entries of the rotation: the row with the largest diagonal keeps its digits
    a, b, c = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    yz, zx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    ab, bc, ca = m[:, 1, 0] + m[:, 0, 1], m[:, 2, 1] + m[:, 1, 2], m[:, 0, 2] + m[:, 2, 0]
    products = np.array([[1.0 + a + b + c, yz, zx, xy], [yz, 1.0 + a - b - c, ab, ca],
                         [zx, ab, 1.0 - a + b - c, bc], [xy, ca, bc, 1.0 - a - b + c]])
    best = np.argmax(np.einsum("iin->in", products), axis=0)
    quaternion = products[best, :, np.arange(len(best))]
    return (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True),
            np.column_stack((length, np.ones(len(length)))))
