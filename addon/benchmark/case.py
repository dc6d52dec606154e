"""The input of a benchmark: the view, mirrors and diffuse scene of the open file, as arrays."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, TriangleMesh, View
from ..judge import polygons
from ..reading import DiffuseScene, choose, read_mirror, read_scene, read_view, render_size

LEAST_PIXELS = 8


@dataclass(frozen=True)
class Case:
    """One scene to run every method on.

    Attributes
    ----------
    view : core.View
    mirror : core.TriangleMesh
        Several mirrors are one mesh: what one shows of another is the mirror itself, and left out by every method.
    scene : DiffuseScene
    mirrors, diffuse : list of bpy.types.Object
    polygon : (m,) int64
        The polygon, in its object, of each triangle of the scene, as Cycles' codes number them; -1 where unknown.
    triangle : (t,) int64
        Index, in its mirror object, of each triangle of the mirror.
    """

    view: View
    mirror: TriangleMesh
    scene: DiffuseScene
    mirrors: list
    diffuse: list
    polygon: np.ndarray
    triangle: np.ndarray


def read_case(context: bpy.types.Context, pixels: int | None = None) -> Case:
    """Read the open file as `generate` does; `pixels` is the picture's longer side, the render's own where None.

    Raises
    ------
    ReflectionError
        Where no mirror, no diffuse object or no camera takes part, or one of them cannot be read.
    """
    if context.mode != "OBJECT":
        raise ReflectionError("Methods are benchmarked in Object Mode: leave the present mode first.")
    chosen = choose(context)
    size = render_size(context.scene)
    if pixels is not None:
        if pixels < LEAST_PIXELS:
            raise ReflectionError(f"A benchmark takes at least {LEAST_PIXELS} pixels: raise --resolution.")
        size = tuple(max(1, round(side * pixels / max(size))) for side in size)
    view = read_view(context, size)
    depsgraph = context.evaluated_depsgraph_get()
    surfaces = [read_mirror(depsgraph, mirror) for mirror in chosen.mirrors]
    scene = read_scene(depsgraph, chosen.diffuse)
    return Case(view, TriangleMesh.joined([surface.mesh for surface in surfaces]), scene, chosen.mirrors,
                chosen.diffuse, _polygons(context, scene), np.concatenate([surface.triangle for surface in surfaces]))


def _polygons(context: bpy.types.Context, scene: DiffuseScene) -> np.ndarray:
    found = np.full(len(scene.mesh.triangles), -1, dtype=np.int64)
    for index, table in enumerate(polygons(context, scene.sources)):
        own = np.flatnonzero(scene.source_object == index)
        if table is not None:
            own = own[scene.source_face[own] < len(table)]
            found[own] = table[scene.source_face[own]]
    return found
