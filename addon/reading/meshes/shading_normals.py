"""The normals by which Cycles shades a mesh."""
from __future__ import annotations

import bpy
import numpy as np

from ... import compat

BENT = 1e-6  # between unit normals: what differs by less is rounding
APART = 1e-9  # radians: far above rounding, and far below what a picture shows
ASKEW = (0.31, 0.57, 0.76)  # no axis of anything


def corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    """Of face corners, (n, 3) float32: smooth, flat or custom; those of a flat face are that face's."""
    normals = _vectors(mesh.corner_normals)
    if compat.smooth_faces_take_vertex_normals(mesh):
        smooth = np.repeat(_is_smooth(mesh), _sides(mesh))
        vertex = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
        normals[smooth] = _vectors(mesh.vertex_normals)[vertex[smooth]]
    return normals


def bent_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """Which faces Cycles shades by the normals of their triangles, be these of one plane or not: flat ones, but where
    it takes the normals of corners."""
    if mesh.normals_domain == "FACE":
        return _sides(mesh) > 3
    if compat.smooth_faces_take_vertex_normals(mesh):
        return ~_is_smooth(mesh) & (_sides(mesh) > 3)
    return np.zeros(len(mesh.polygons), dtype=bool)


def with_bent_faces(normals: np.ndarray, corners: np.ndarray, bent: np.ndarray) -> np.ndarray:
    """Normals (m, 3, 3) of triangles whose corners lie at (m, 3, 3), those of some that are `bent` (m,) by themselves,
    where they do not lie in the plane of their face."""
    some = np.flatnonzero(bent)
    place = corners[some].astype(np.float64)
    own = np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0])
    length = np.linalg.norm(own, axis=1)
    own /= np.where(length > 0.0, length, 1.0)[:, None]
    off = (length > 0.0) & (np.abs(own - normals[some, 0]).max(axis=1) > BENT)
    normals[some[off]] = own[off, None].astype(np.float32)
    return normals


def told_apart(normals: np.ndarray, material: np.ndarray) -> np.ndarray:
    """Normals (m, 3, 3) of a mirror's triangles that agree in no corner in which several materials (m,) meet.

    A face of a result lies over several triangles of the mirror where their normals agree, and else in each of them by
    itself: so it lies on one material.
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
