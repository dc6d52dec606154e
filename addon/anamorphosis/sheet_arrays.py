"""A source object cut along what a mirror shows of it, as arrays: the copy that a picture is put on."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import breathe
from ...core.geometry import distinct, first_of
from ..reading import DiffuseScene
from ..writing import MOST_UV_MAPS, Attribute, Edges, MeshArrays, shown_layers
from .cut_triangles import Parts
from .frame import Frame

UV_MAP = "Mirror UV"
SEEN = "mirror_seen"
BITS = 21           # bits of a coordinate, counted in units of ONE_PLACE
ONE_PLACE = 1e-6    # relative to a sheet's size; closer vertices of neighbouring faces are merged


@dataclass(frozen=True)
class Sheet:
    """One source object that was cut: `arrays` in the space of `matrix`, shading `normals` (m, 3, 3), and the names of
    UV maps for which there is no room beside the new one.
    """

    source: bpy.types.Object
    matrix: np.ndarray
    arrays: MeshArrays
    normals: np.ndarray
    left_out: tuple[str, ...] = ()


def sheet(index: int, scene: DiffuseScene, parts: Parts, frame: Frame) -> Sheet:
    """Return the source `index` of `scene`, cut into its `parts`."""
    own = np.flatnonzero(scene.source_object[parts.face] == index)
    face, weights, pixels, seen = parts.face[own], parts.weights[own], parts.pixels[own], parts.seen[own]
    source = scene.sources[index]
    matrix = np.array(source.matrix_world, dtype=np.float64)
    if not np.linalg.cond(matrix[:3, :3]) < 1e6:    # a space as flat as that tells no places
        matrix = np.eye(4)
    inverse = np.linalg.inv(matrix)
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        # such a space turns faces over, and in the world they look to the side of their normals
        weights, pixels = weights[:, ::-1], pixels[:, ::-1]
    breathe()
    places = (weights @ scene.mesh.positions[scene.mesh.triangles[face]]) @ inverse[:3, :3].T + inverse[:3, 3]
    breathe()
    positions, triangles = _welded(places)
    breathe()
    kept = np.flatnonzero((triangles != np.roll(triangles, 1, axis=1)).all(axis=1))
    triangles, face, weights, pixels, seen = (values[kept] for values in (triangles, face, weights, pixels, seen))
    breathe()
    used, material = distinct(scene.material[face])
    own_attributes = (
        Attribute("material_index", "INT", "FACE", material.astype(np.int32)),
        Attribute(SEEN, "BOOLEAN", "FACE", seen),
        Attribute(UV_MAP, "FLOAT2", "CORNER", frame.uv(pixels)))
    breathe()
    single = weights.astype(np.float32)
    layers = shown_layers(scene, own_attributes, "CORNER", lambda values: np.matmul(single, values[face]))
    maps = [layer.name for layer in layers if layer.kind == "FLOAT2"]
    left_out = tuple(maps[MOST_UV_MAPS - 1:])
    layers = tuple(layer for layer in layers if layer.name not in left_out)
    arrays = MeshArrays(np.zeros(3), positions, triangles.astype(np.int32), own_attributes + layers,
                        [scene.materials[entry] for entry in used], edges=Edges.of(triangles))
    breathe()
    # normals turn as the inverse's transpose does: back to the object's space as the matrix's transpose
    turned = weights @ scene.normals[face] @ matrix[:3, :3]
    breathe()
    length = np.linalg.norm(turned, axis=2, keepdims=True)
    return Sheet(source, matrix, arrays, (turned / np.where(length > 0.0, length, 1.0)).astype(np.float32), left_out)


def _welded(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (n, 3) float32 and triangles (m, 3) of corners (m, 3, 3), with coincident corners merged."""
    corners = places.reshape(-1, 3)
    low = corners.min(axis=0)
    grid = max(float((corners.max(axis=0) - low).max()) * ONE_PLACE, 1e-30)
    x, y, z = np.round((corners - low) / grid).astype(np.int64).T
    breathe()
    # no coordinate has more bits than 1 / ONE_PLACE
    _, first, vertex = first_of(((x << BITS | y) << BITS) | z)
    breathe()
    return corners[first].astype(np.float32), vertex.reshape(-1, 3)
