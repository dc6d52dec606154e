"""Far from the origin: a scene whose coordinates dwarf its mirror is worked on beside the origin.

Coordinates far out spend their digits on where the mirror is, and leave few for what it looks like: places and rays
would be rounded to the spacing of numbers out there over and over. The difference of two numbers as near to each
other as those of one scene is exact or rounded no more than they were themselves, so moving everything by a corner of
the mirror's box loses nothing, and what follows has all digits.
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

FAR = 1024.0  # sizes of the mirror: nearer ones keep 43 of 53 bits
Surface = TypeVar("Surface", bound=TriangleMesh | SceneTree | PointTree)


def far_corner(mirror: TriangleMesh) -> np.ndarray | None:
    """The low corner (3,) of the box round a mirror that is far from the origin for its size, None for any other.

    It is made of the mirror's own coordinates, so that it moves and scales with the scene to the last bit.
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
    """A copy moved by `offset` (3,); of a tree, with spheres that hold what the moving rounds."""
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
    """A copy with other values, which are known to be good."""
    copied = copy(surface)
    for made in ("bodies", "boxes", "vertices"):
        vars(copied).pop(made, None)
    for name, value in values.items():
        object.__setattr__(copied, name, value)
    return copied
