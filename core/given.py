"""Input validation for `reflect`: its arguments have the right types, are not empty, and the eye is off the mirror."""
from __future__ import annotations

import numpy as np

from .geometry import Opacity, TriangleMesh, area_normals, cross, dot, norm, rows
from .support import LARGEST, NothingInView, ReflectionError, Settings, must_be, whole_numbers
from .trees import PointTree, SceneTree
from .views import View

NO_AREA = "The mirror has no face with an area; give it faces or choose another mirror."


def check_given(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree | PointTree, settings: Settings,
                mirrors: TriangleMesh | None) -> None:
    """Raise `ReflectionError` if `reflect` cannot work with its arguments."""
    must_be(view, View, "The view must be a View; make one of a camera's matrices or with looking_at.")
    must_be(mirror, TriangleMesh, "The mirror must be a TriangleMesh; make one of its positions and triangles.")
    must_be(scene, (TriangleMesh, SceneTree, PointTree), "The scene must be a TriangleMesh, a SceneTree or a "
            "PointTree; make one of its positions and triangles.")
    must_be(settings, Settings, "The settings must be Settings; leave them out for the defaults.")
    must_be(mirrors, (TriangleMesh, type(None)), "The mirrors must be one TriangleMesh; join them or leave them out.")
    if not len(mirror.triangles):
        raise ReflectionError("The mirror has no faces; give it faces or choose another mirror.")
    if mirrors is not None and not len(mirrors.triangles):
        raise ReflectionError("The mirrors have no faces; give all mirrors, this one among them, or leave them out.")
    if isinstance(scene, TriangleMesh) and not len(scene.triangles) and settings.method != "POINTS":
        raise ReflectionError("The reflected objects have no faces; select objects with faces to reflect.")
    if np.abs(view.eye).max() > LARGEST:
        raise ReflectionError("The view's eye is further than 1e40 from the origin; move it nearer or make the scene "
                              "smaller.")
    corners = rows(mirror.positions[mirror.triangles.T])
    normals = area_normals(corners)
    length = norm(normals)
    if not (length > 0.0).any():
        raise NothingInView(NO_AREA)
    if not view.orthographic and _touched(view.eye, corners, normals, length):
        raise ReflectionError("The eye lies on the mirror; move the camera away from the mirror's surface.")


def checked_opacity(scene: TriangleMesh | SceneTree | PointTree, opacity: np.ndarray | None) -> np.ndarray | None:
    """Return the opacity (m,) of a scene's triangles as int8; raise `ValueError` if it is none."""
    if opacity is None:
        return None
    mesh = scene if isinstance(scene, TriangleMesh) else scene.mesh
    wrong = "The opacity must be an (m,) array of Opacity values; give one for each triangle of the scene."
    found = whole_numbers(opacity, (len(mesh.triangles),), wrong)
    if len(found) and not (Opacity.CLEAR <= found.min() and found.max() <= Opacity.OPAQUE):
        raise ValueError(wrong)
    return found.astype(np.int8)


def _touched(eye: np.ndarray, corners: np.ndarray, normals: np.ndarray, length: np.ndarray) -> bool:
    """Return True if the eye (3,) lies on one of m triangles.

    Parameters
    ----------
    eye : (3,) float64
    corners : (3, 3, m) float64, as [component, corner, triangle]
    normals : (3, m) float64, area normals of the triangles
    length : (m,) float64, lengths of the normals
    """
    offset = eye[:, None, None] - corners
    height = np.abs(dot(normals[:, None], offset)).min(axis=0) / np.where(length > 0.0, length, np.inf)
    near = np.flatnonzero((length > 0.0) & (height < 1e-6 * np.sqrt(length)))
    a, b, c = offset[:, :, near].swapaxes(0, 1)
    inside = [dot(cross(p, q), normals[:, near]) >= 0.0 for p, q in ((a, b), (b, c), (c, a))]
    return bool(np.all(inside, axis=0).any())
