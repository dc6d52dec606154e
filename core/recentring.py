"""Translation of scenes far from the origin, relative to the mirror's size, to the origin and back.

Large coordinates use most of their digits for the mirror's position and few for its shape: places and rays would be
rounded again and again. The difference of two nearby numbers is exact, or rounded no more than the numbers were. So
moving everything by a corner of the mirror's bounding box loses nothing, and later steps have full precision.
"""
from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import TypeVar, cast

import numpy as np

from .geometry import TriangleMesh
from .result import ReflectionMesh
from .trees import PointTree, SceneTree
from .views import LampView, View

FAR = 1024.0  # distance from the origin in mirror sizes: nearer mirrors keep 43 of 53 bits
Surface = TypeVar("Surface", bound=TriangleMesh | SceneTree | PointTree)


def far_corner(mirror: TriangleMesh) -> np.ndarray | None:
    """Return the low corner (3,) of the mirror's bounding box if the mirror is far from the origin, else None.

    The corner consists of the mirror's own coordinates, so it moves and scales with the scene to the last bit.
    """
    used = mirror.positions[mirror.triangles.ravel()]
    low = used.min(axis=0)
    return low if np.abs(low).max() > FAR * (used.max(axis=0) - low).max() else None


def moved_view(view: View, offset: np.ndarray) -> View:
    placement = view.camera_to_world.copy()
    placement[:3, 3] += offset
    view = replace(view, camera_to_world=placement)
    if isinstance(view, LampView):
        shades, screens = (None if mesh is None else moved_surface(mesh, offset)
                           for mesh in (view.shades, view.screens))
        return replace(view, shades=shades, screens=screens)
    return view


def moved_surface(surface: Surface, offset: np.ndarray) -> Surface:
    """Return a copy translated by `offset` (3,); bounding spheres of trees are enlarged by the rounding error."""
    if isinstance(surface, TriangleMesh):
        return cast(Surface, surface.like(surface.positions + offset, surface.triangles, surface.corner_normals))
    moved = _with(surface, mesh=moved_surface(surface.mesh, offset),
                  spheres=[_moved(part, offset) for part in surface.spheres])
    if isinstance(surface, SceneTree):
        return _with(moved, triangle_spheres=_moved(surface.triangle_spheres, offset))
    return moved


def moved_mesh(mesh: ReflectionMesh, offset: np.ndarray) -> ReflectionMesh:
    return replace(mesh, **{name: getattr(mesh, name) + offset
                            for name in ("positions", "reflected_position", "mirror_position")})


def _moved(spheres: np.ndarray, offset: np.ndarray) -> np.ndarray:
    room = np.finfo(np.float64).eps * (np.abs(spheres[:3]).max(axis=0) + np.abs(offset).max())
    return np.concatenate((spheres[:3] + offset[:, None], (spheres[3] + 4.0 * room)[None]))


def _with(surface: Surface, **values: object) -> Surface:
    """Return a copy with other attribute values, without checks, and without cached properties."""
    copied = copy(surface)
    for made in ("bodies", "boxes", "vertices"):
        vars(copied).pop(made, None)
    for name, value in values.items():
        object.__setattr__(copied, name, value)
    return copied
