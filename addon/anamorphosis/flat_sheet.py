"""A flat object as it lies on the printer: its plane, its size, and where each corner's map points."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError
from .sheet_arrays import SEEN, UV_MAP

FLAT = 1e-3     # largest thickness, relative to a sheet's size


@dataclass(frozen=True)
class FlatSheet:
    """Triangles in the plane of a sheet, seen from the side of its mirror.

    Attributes
    ----------
    corners : (m, 3, 2) float64
        In metres, right and up from the sheet's lower left corner.
    uv : (m, 3, 2) float64
        Positions of the corners in the picture.
    seen : (m,) bool
    size : (2,) float64
        Width and height in metres.
    """

    corners: np.ndarray
    uv: np.ndarray
    seen: np.ndarray
    size: np.ndarray


def why_no_sheet(obj: bpy.types.Object) -> str:
    """Return a sentence if an object has no map of a mirror; "" if it has one."""
    if obj.type == "MESH" and UV_MAP in obj.data.uv_layers and SEEN in obj.data.attributes:
        return ""
    return f"'{obj.name}' has no UV map '{UV_MAP}': press Write Mirror UVs first."


def flat_sheet(obj: bpy.types.Object, metres: float) -> FlatSheet:
    """Return the sheet `obj`, which has the map of a mirror. Its own Y axis is up, and a unit has `metres`.

    Raises
    ------
    ReflectionError
        If it has no map, is not flat, or has no area.
    """
    without = why_no_sheet(obj)
    if without:
        raise ReflectionError(without)
    mesh = obj.data
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    loops, polygon = np.empty((count, 3), dtype=np.int32), np.empty(count, dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", loops.reshape(-1))
    mesh.loop_triangles.foreach_get("polygon_index", polygon)
    vertex, uv = np.empty(len(mesh.loops), dtype=np.int32), np.empty((len(mesh.loops), 2), dtype=np.float32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
    mesh.uv_layers[UV_MAP].uv.foreach_get("vector", uv.reshape(-1))
    seen = np.empty(len(mesh.polygons), dtype=bool)
    mesh.attributes[SEEN].data.foreach_get("value", seen)
    places = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", places.reshape(-1))
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    world = places[vertex].astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    if not np.isfinite(world).all():
        raise ReflectionError(f"'{obj.name}' has a transform that is not a finite number: clear its location, rotation "
                              "and scale.")
    flat = (world - world.mean(axis=0)) @ _axes(obj, world, matrix).T
    low = flat.min(axis=0)
    return FlatSheet((flat - low)[loops] * metres, uv[loops].astype(np.float64), seen[polygon],
                     (flat.max(axis=0) - low) * metres)


def _axes(obj: bpy.types.Object, world: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Return the unit directions right and up (2, 3) of a flat sheet, as seen from the side of its mirror."""
    middle = world.mean(axis=0)
    _, extent, axes = np.linalg.svd(world - middle, full_matrices=False)
    if extent[1] <= FLAT * extent[0]:
        raise ReflectionError(f"'{obj.name}' has no area to print: clear its scale, or choose another object.")
    if extent[2] > FLAT * extent[1]:
        raise ReflectionError(f"'{obj.name}' is not flat, and cannot be printed on a sheet: choose a flat object.")
    normal, mirror = axes[2], obj.reflection_mesh.mirror
    if mirror is not None:
        place = np.array(mirror.matrix_world)
        towards = place[:3, :3] @ np.array(mirror.bound_box).mean(axis=0) + place[:3, 3]
        normal = normal if normal @ (towards - middle) >= 0.0 else -normal
    # the object's own axis that lies in the plane best
    own = [matrix[:3, 1], matrix[:3, 0], matrix[:3, 2]]
    ups = np.array([axis / max(np.linalg.norm(axis), 1e-30) for axis in own])
    ups -= np.outer(ups @ normal, normal)
    length = np.linalg.norm(ups, axis=1)
    up = ups[0] if length[0] > 0.5 else ups[np.argmax(length)]
    up /= np.linalg.norm(up)
    return np.stack((np.cross(up, normal), up))
