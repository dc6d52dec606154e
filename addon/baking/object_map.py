"""Which part of a picture of objects' light each corner of a result shows; kept with the file."""
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import bpy
import numpy as np

from ...core import View, reflecting_normals
from ..faults import Steps
from ..mirror_part import LATER, write_later_tints
from ..reading import DiffuseScene, corner_vertices, vectors
from ..reading.materials import asked_attributes
from ..writing import LATER_MATERIAL, NORMAL, images_of, light_layer
from .mirror_layers import write_mirror_layers
from .seen_sources import fronts_shown, triangle_of, triangles_by_source, weights_of
from .true_places import show_patterns_in_place

WRITING, FRAME = "Writing", "frame"


@dataclass(frozen=True)
class KeptMap:
    """Where light lies in a picture, as `ObjectLight` has it: a mesh whose points are the corners of triangles keeps
    it, and is saved with the file, and appended with a result; `dull` are names as `ObjectLight` has them."""

    mesh: bpy.types.Mesh
    sheets: list
    dull: tuple = ()

    @property
    def uv(self) -> np.ndarray:
        """(m, 3, 2) float32."""
        points = np.empty((len(self.mesh.vertices), 3), dtype=np.float32)
        self.mesh.attributes["position"].data.foreach_get("vector", points.reshape(-1))
        return points[:, :2].reshape(-1, 3, 2)

    @property
    def frames(self) -> np.ndarray:
        """(m, 2, 2) float32: of maps of earlier versions, in which each sheet had a square of its own, the whole."""
        kept = self.mesh.attributes.get(FRAME)
        if kept is None:
            return np.broadcast_to(np.array(((0.0,), (1.0,)), dtype=np.float32), (len(self.mesh.vertices) // 3, 2, 2))
        ends = np.empty((len(self.mesh.vertices), 2), dtype=np.float32)
        kept.data.foreach_get("vector", ends.reshape(-1))
        return ends.reshape(-1, 3, 2)[:, :2]


def kept_map(name: str, uv: np.ndarray, frames: np.ndarray) -> bpy.types.Mesh:
    """A mesh for `KeptMap`."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(3 * len(uv))
    points = np.zeros((3 * len(uv), 3), dtype=np.float32)
    points[:, :2] = uv.reshape(-1, 2)
    mesh.attributes["position"].data.foreach_set("vector", points.reshape(-1))
    # of a triangle's three points two are enough to tell it
    ends = frames[:, (0, 1, 1)].astype(np.float32)
    mesh.attributes.new(FRAME, "FLOAT2", "POINT").data.foreach_set("vector", ends.reshape(-1))
    return mesh


def lay_out(result: bpy.types.Object, view: View, scene: DiffuseScene, kept: KeptMap,
            material: bpy.types.Material) -> Steps[None]:
    """Tell each corner of a result where in the map the point lies that it shows, and how the mirror stands there and
    what its layers are, as far as the `material` that shows the map asks for them."""
    mesh = result.data
    yield from show_patterns_in_place(result, view, scene)
    write_mirror_normals(mesh, view)
    asked = asked_attributes([material])
    write_mirror_layers(result, view, asked)
    if asked & LATER:
        write_later_tints(result)
    # engines darken what is shaded by one normal and stands by another, and here the mirror is what is shaded
    own = mesh.attributes.get("custom_normal")
    if own is not None:
        mesh.attributes.remove(own)
    yield 0.0, WRITING
    triangle = triangle_of(result, scene)
    shown, front = vectors(mesh, "reflected_position")[corner_vertices(mesh)], fronts_shown(
        mesh, view, scene, triangle)
    yield 0.0, WRITING
    weights = weights_of(scene.mesh.positions[scene.mesh.triangles[triangle]], shown)
    yield 0.0, WRITING
    half = max((0.5 / min(image.size) for image in images_of(material) if all(image.size)), default=0.0)
    spots = _spots(kept, rows_of(scene, kept.sheets), (triangle, front), weights, half)
    yield 0.0, WRITING
    layer = light_layer(mesh)
    layer.uv.foreach_set("vector", spots.reshape(-1))
    layer.active = layer.active_render = True


def knows_mirror_normals(mesh: bpy.types.Mesh) -> bool:
    """Whether a result knows enough to tell how the mirror stands at each of its points."""
    if LATER_MATERIAL.format(2) in mesh.attributes:
        return NORMAL in mesh.attributes
    return all(name in mesh.attributes for name in ("mirror_position", "reflected_position"))


def write_mirror_normals(mesh: bpy.types.Mesh, view: View) -> None:
    """Tell each point of a result how the mirror stands there, where that is known. One that is seen by several mirrors
    was generated with it."""
    if LATER_MATERIAL.format(2) in mesh.attributes or not knows_mirror_normals(mesh):
        return
    normals = reflecting_normals(view, vectors(mesh, "mirror_position"), vectors(mesh, "reflected_position"))
    attribute = mesh.attributes.get(NORMAL) or mesh.attributes.new(NORMAL, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", normals.astype(np.float32).reshape(-1))


def _spots(kept: KeptMap, rows: list[tuple[np.ndarray, np.ndarray]], seen: tuple[np.ndarray, np.ndarray],
           weights: np.ndarray, half: float) -> np.ndarray:
    """Where in the map the corners of faces lie, (n, 3, 2) float32, by the `weights` (n, 3, 3) of those of their
    triangles (n,), of which they show the front, or the back, both as `seen`: in the finest sheet that holds all of a
    face, but for the `half` of a texel by which those on a sheet's rim lie beside the middle of its last one."""
    triangle, front = seen
    uv, frames = kept.uv, kept.frames
    fronts, backs = (side[triangle] >= 0 for side in rows[0])
    # the same for both sides where the map has but one of them
    front = np.where(front, fronts, ~backs)
    found = np.zeros((len(triangle), 3, 2))
    for level, (fronts, backs) in enumerate(rows):
        row = np.where(front, fronts[triangle], backs[triangle])
        there = np.flatnonzero(row >= 0)
        row = row[there]
        spots = np.matmul(weights[there], uv[row].astype(np.float64))
        within = np.clip(spots, frames[row, :1], frames[row, 1:])
        # what mirrors could not show when it was baked has no room, and must not show what else there is
        held = (np.abs(within - spots) <= half).all(axis=(1, 2)) if level else np.ones(len(there), dtype=bool)
        found[there[held]] = within[held]
    return found.astype(np.float32)


def rows_of(scene: DiffuseScene, sheets: list) -> list[tuple[np.ndarray, np.ndarray]]:
    """Which triangle of the map is the front of each triangle of the scene, and which its back, -1 where the map does
    not have that; of those that it has several times first the coarsest."""
    parts, start, count = triangles_by_source(scene), 0, len(scene.source_object)
    rows: list[tuple[np.ndarray, np.ndarray]] = []
    levels: Counter = Counter()
    for number, back in sheets:
        level = levels[number, back]
        levels[number, back] += 1
        if level == len(rows):
            rows.append((np.full(count, -1), np.full(count, -1)))
        rows[level][back][parts[number]] = start + np.arange(len(parts[number]))
        start += len(parts[number])
    return rows
