"""Detect opaque objects that are hidden from the camera only, e.g. walls that were removed to see into a room."""
from __future__ import annotations

import bpy
import numpy as np


def looked_through(depsgraph: bpy.types.Depsgraph, mirrors: list, diffuse: list) -> bool:
    """Return True if the box of an object hidden from the camera intersects the box of a mirror. Hidden instancers
    always count.
    """
    unseen = [obj for obj in diffuse if is_unseen(obj, depsgraph.view_layer)]
    if not unseen:
        return False
    boxes = [_box(obj.evaluated_get(depsgraph)) for obj in mirrors]
    # boxes tell nothing of where instances are
    return any(obj.is_instancer or any(_meet(_box(obj.evaluated_get(depsgraph)), box) for box in boxes)
               for obj in unseen)


def is_unseen(obj: bpy.types.Object, layer: bpy.types.ViewLayer) -> bool:
    """Return True for an object that the camera does not see, or of whose instances it does not see all."""
    if not obj.visible_camera or obj.indirect_only_get(view_layer=layer):
        return True
    inner = obj.instance_collection if obj.instance_type == "COLLECTION" else None
    return inner is not None and not all(other.visible_camera for other in inner.all_objects)


def _box(evaluated: bpy.types.Object) -> np.ndarray:
    """Return the lowest and the highest corner (2, 3) of the bounding box of an object, in world space."""
    matrix = np.array(evaluated.matrix_world, dtype=np.float64)
    corners = np.array(evaluated.bound_box, dtype=np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return np.stack((corners.min(axis=0), corners.max(axis=0)))


def _meet(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(((one[0] <= other[1]) & (other[0] <= one[1])).all())
