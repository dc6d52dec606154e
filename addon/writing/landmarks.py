"""Vertices that identify transforms which were applied to a result's mesh (Object > Apply)."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

NEARLY = 1e-4   # relative to the mesh's size; tolerance for single precision, larger far from the origin


def note_landmarks(obj: bpy.types.Object) -> None:
    """Record the positions of three vertices far apart, and of a fourth one, in the space of a result."""
    record, places = obj.reflection_mesh, np.empty((len(obj.data.vertices), 3), dtype=np.float32)
    if not len(places):
        forget_landmarks(obj)
        return
    obj.data.attributes["position"].data.foreach_get("vector", places.reshape(-1))
    places = places.astype(np.float64)
    first = int(places[:, 0].argmin())
    away = places - places[first]
    second = int((away**2).sum(axis=1).argmax())
    third = int((np.cross(away, away[second])**2).sum(axis=1).argmax())
    away = places - places[[first, second, third]].mean(axis=0)
    record.landmarks = first, second, third, int((away**2).sum(axis=1).argmax())
    record.landmark_places = places[list(record.landmarks)].ravel()


def forget_landmarks(obj: bpy.types.Object) -> None:
    """Forget the landmarks of a result whose vertices were moved deliberately."""
    obj.reflection_mesh.landmarks = 0, 0, 0, 0


def applied_to(obj: bpy.types.Object) -> Matrix:
    """Return the transform that was applied to a result's mesh since it was generated. Return the identity if there is
    none, or if the mesh was edited otherwise.
    """
    record, nothing = obj.reflection_mesh, Matrix.Identity(4)
    numbers, vertices = list(record.landmarks), obj.data.vertices
    if not any(numbers) or max(numbers) >= len(vertices):
        return nothing
    before = np.array(record.landmark_places, dtype=np.float64).reshape(4, 3)
    now = np.array([vertices[number].co for number in numbers], dtype=np.float64)
    size = max(np.ptp(before, axis=0).max(), np.ptp(now, axis=0).max()) + 1e-3 * np.abs(now).max()
    if np.abs(now - before).max() <= NEARLY * size:
        return nothing
    frame = _frame(before)
    if np.linalg.matrix_rank(frame) < 4:
        return nothing
    found = _frame(now) @ np.linalg.inv(frame)
    if np.abs(found[:3, :3] @ before[3] + found[:3, 3] - now[3]).max() > NEARLY * size:
        return nothing
    return Matrix(found.tolist())


def _frame(places: np.ndarray) -> np.ndarray:
    """Return three points, and a fourth one beside their plane at a similar distance, as columns (4, 4)."""
    across = np.cross(places[1] - places[0], places[2] - places[0])
    length = np.linalg.norm(across)
    beside = places[0] + (across / np.sqrt(length) if length else across)
    return np.vstack((np.column_stack((*places[:3], beside)), np.ones(4)))
