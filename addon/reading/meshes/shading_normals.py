"""Compute the normals that Cycles uses for shading a mesh."""
from __future__ import annotations

import bpy
import numpy as np

from ... import compat

BENT = 1e-6  # smaller differences of unit normals are rounding errors
APART = 1e-9  # radians: far above rounding, and far below what a picture shows
ASKEW = (0.31, 0.57, 0.76)  # a direction that is parallel to no axis


def corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the shading normals of the face corners, (n, 3) float32: smooth, flat or custom. Corners of a flat face
    have the normal of the face.
    """
    normals = _vectors(mesh.corner_normals)
    if compat.smooth_faces_take_vertex_normals(mesh):
        smooth = np.repeat(_is_smooth(mesh), _sides(mesh))
        vertex = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
        normals[smooth] = _vectors(mesh.vertex_normals)[vertex[smooth]]
    return normals


def bent_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return True (p,) for flat faces with more than three sides. Cycles shades these with the normals of their
    triangles, which differ if the face is not planar. False for faces where Cycles uses the normals of corners.
    """
    if mesh.normals_domain == "FACE":
        return _sides(mesh) > 3
    if compat.smooth_faces_take_vertex_normals(mesh):
        return ~_is_smooth(mesh) & (_sides(mesh) > 3)
    return np.zeros(len(mesh.polygons), dtype=bool)


def with_bent_faces(normals: np.ndarray, corners: np.ndarray, bent: np.ndarray) -> np.ndarray:
    """Return the normals (m, 3, 3) with those of `bent` (m,) triangles replaced by the triangle's own normal if it
    differs from the face's. `corners` (m, 3, 3) are the positions of the triangles' corners.
    """
    some = np.flatnonzero(bent)
    place = corners[some].astype(np.float64)
    own = np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0])
    length = np.linalg.norm(own, axis=1)
    own /= np.where(length > 0.0, length, 1.0)[:, None]
    off = (length > 0.0) & (np.abs(own - normals[some, 0]).max(axis=1) > BENT)
    normals[some[off]] = own[off, None].astype(np.float32)
    return normals


def told_apart(normals: np.ndarray, material: np.ndarray) -> np.ndarray:
    """Return the corner normals (m, 3, 3) of a mirror's triangles, turned by `APART` times their `material` (m,).

    A face of the reflection may extend over neighbouring mirror triangles if their normals at shared corners are
    equal. So no face extends over two materials.
    """
    if not len(material) or (material == material[0]).all():
        return normals
    return normals + APART * material[:, None, None] * np.cross(normals, ASKEW)


def _is_smooth(mesh: bpy.types.Mesh) -> np.ndarray:
    smooth = np.empty(len(mesh.polygons), dtype=bool)
    mesh.polygons.foreach_get("use_smooth", smooth)
    return smooth


def _sides(mesh: bpy.types.Mesh) -> np.ndarray:
    sides = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_total", sides)
    return sides


def _vectors(data) -> np.ndarray:
    values = np.empty((len(data), 3), dtype=np.float32)
    data.foreach_get("vector", values.reshape(-1))
    return values
