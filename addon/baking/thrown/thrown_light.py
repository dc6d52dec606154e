"""Meshes of light on objects: what of them lies where in the picture of the objects' light."""
from __future__ import annotations

import bpy
import numpy as np

from ....core import breathe
from ...faults import Steps
from ...reading import DiffuseScene, corner_vertices, seen_in
from ...rendering import shown_while, sum_around
from ...writing import FIELDS, Attribute, MeshArrays
from ..object_map import rows_of
from ..seen_sources import fronts_seen, triangles_in, weights_of
from .drawn_flat import drawn_flat

WIDTHS = {"FLOAT": 1, "INT": 1, "FLOAT2": 2, "FLOAT_VECTOR": 3}
DRAWING = "Rendering caustics"
RINGS = 2       # of texels beyond a triangle, which interpolation looks at
TOGETHER = -1   # the picture of all sheets that lie in their frames
CLOSE = 0.6     # of a texel beyond its frame, the outer half of whose last texels is left out of it
LEAST = 0.05    # of a texel: a triangle that holds less does not tell its light


def thrown_light(context: bpy.types.Context, scene: DiffuseScene, sheets: list, places: tuple[np.ndarray, np.ndarray],
                 side: int) -> Steps[tuple[np.ndarray, set]]:
    """The light that mirrors throw on the objects of `scene`, as white paint would send it back.

    Parameters
    ----------
    sheets
        As `ObjectLight` has them.
    places : (m, 3, 2) and (m, 2, 2) float64
        The triangles' corners, and what belongs to their sheets, in a square picture of the objects' light, 0 to 1.
    side : int
        Of that picture, in texels.

    Returns
    -------
    light : (side, side, 3) float32
        Linear light, by the texels of that picture; nothing where there is none.
    lit : set of (int, bool)
        The sheets on which it falls.
    """
    (uv, frames), seen, levels = places, seen_in(context), rows_of(scene, sheets)
    sheet_of = np.repeat(np.arange(len(sheets)), [np.count_nonzero(scene.source_object == number)
                                                  for number, _ in sheets])
    drawn = _drawn_together(sheet_of, uv, frames, CLOSE / side)
    laid: dict[int, list[MeshArrays]] = {}
    reached = []
    depsgraph = context.evaluated_depsgraph_get()
    for result in [obj for obj in context.view_layer.objects
                   if obj.reflection_mesh.role == "CAUSTICS" and obj.type == "MESH" and seen(obj)]:
        yield 0.0, DRAWING
        mesh = result.evaluated_get(depsgraph).data
        if "source_face" not in mesh.attributes:
            continue
        face, row, corners = (np.concatenate(part) for part in zip(
            *(_on_the_map(result, mesh, scene, rows, uv) for rows in levels), strict=True))
        reached.append(row)
        materials = [slot.material for slot in result.material_slots]
        for group in np.unique(drawn[row]).tolist():
            own = np.flatnonzero(drawn[row] == group)
            above = laid.setdefault(group, [_ground(uv[drawn == group])])
            above.append(_flat(mesh, face[own], corners[own], float(len(above)), materials))
    if not laid:
        return np.zeros((0, 0, 3), dtype=np.float32), set()
    row, light = np.unique(np.concatenate(reached)), np.zeros((side, side, 3), dtype=np.float32)
    # what is drawn by itself comes last, each in its own frame
    for group in sorted(laid):
        own = row[drawn[row] == group]
        seen_of = np.clip(uv[own], frames[own, :1], frames[own, 1:])
        low = np.clip(np.floor(side * seen_of.min(axis=(0, 1))).astype(np.int64) - RINGS, 0, side - 1)
        high = np.clip(np.ceil(side * seen_of.max(axis=(0, 1))).astype(np.int64) + RINGS, low + 1, side)
        if group != TOGETHER:
            low = np.maximum(low, np.floor(side * frames[own[0], 0]).astype(np.int64))
            high = np.minimum(high, np.ceil(side * frames[own[0], 1]).astype(np.int64))
        picture = yield from shown_while(drawn_flat(context, laid[group], low, high, side), 0.0, DRAWING)
        light[low[1]:high[1], low[0]:high[0]] = _beyond(picture[..., :3], picture[..., 3:])
    return light, {sheets[index] for index in np.unique(sheet_of[row]).tolist()}


def _drawn_together(sheet_of: np.ndarray, uv: np.ndarray, frames: np.ndarray, room: float) -> np.ndarray:
    """In which picture each of the map's triangles (m,) is drawn: `TOGETHER`, or, where some of its sheet reach farther
    beyond what belongs to it than there is room and would cover others, the sheet's own."""
    beyond = ((uv < frames[:, :1] - room) | (uv > frames[:, 1:] + room)).any(axis=(1, 2))
    apart = np.bincount(sheet_of, beyond) > 0.0
    return np.where(apart[sheet_of], sheet_of, TOGETHER)


def _on_the_map(result: bpy.types.Object, mesh: bpy.types.Mesh, scene: DiffuseScene, rows: tuple,
                uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the faces of thrown light that lie on what the map has: which they are, the map's triangles, and where in it
    their corners lie, (n, 3, 2)."""
    triangle = triangles_in(result, mesh, scene)
    points = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", points.reshape(-1))
    placed = np.array(result.matrix_world, dtype=np.float64)
    corners = (points @ placed[:3, :3].T + placed[:3, 3])[corner_vertices(mesh)]
    towards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    row = np.where(fronts_seen(scene, triangle, towards), rows[0][triangle], rows[1][triangle])
    breathe()
    face = np.flatnonzero((triangle >= 0) & (row >= 0))
    row, own = row[face], scene.mesh.triangles[triangle[face]]
    weights = weights_of(scene.mesh.positions[own], corners[face])
    return face, row, np.matmul(weights, uv[row].astype(np.float64))


def _flat(mesh: bpy.types.Mesh, face: np.ndarray, places: np.ndarray, height: float, materials: list) -> MeshArrays:
    """Faces of a mesh at `places` (n, 3, 2) in a plane, each with corners of its own and a little above the one before:
    Cycles takes surfaces in one place for one."""
    corner = (3 * face[:, None] + np.arange(3)).ravel()
    above = np.repeat(height + np.arange(len(face)) / len(face), 3)
    positions = np.column_stack((places.reshape(-1, 2), above)).astype(np.float32)
    # nodes ask for the light, and for where on a textured mirror it comes from
    kept = [one for one in mesh.attributes if one.data_type in WIDTHS and not one.name.startswith(".")
            and (one.domain == "CORNER" or one.name == "material_index")]
    return MeshArrays(np.zeros(3), positions, np.arange(len(corner), dtype=np.int32).reshape(-1, 3), tuple(
        Attribute(one.name, one.data_type, one.domain, _values(one)[corner if one.domain == "CORNER" else face])
        for one in kept), materials)


def _values(attribute: bpy.types.Attribute) -> np.ndarray:
    kind = attribute.data_type
    values = np.empty((len(attribute.data), WIDTHS[kind]), dtype=np.int32 if kind == "INT" else np.float32)
    attribute.data.foreach_get(FIELDS.get(kind, "value"), values.reshape(-1))
    return values


def _ground(uv: np.ndarray) -> MeshArrays:
    """All triangles of the map: what of a texel they hold is known."""
    positions = np.column_stack((uv.reshape(-1, 2), np.zeros(3 * len(uv)))).astype(np.float32)
    return MeshArrays(np.zeros(3), positions, np.arange(len(positions), dtype=np.int32).reshape(-1, 3), (), [None])


def _beyond(light: np.ndarray, known: np.ndarray) -> np.ndarray:
    """The light (height, width, 3) of what is `known` (height, width, 1) of each texel, and beyond it, where nothing
    is, as its neighbours have it."""
    told = known > LEAST
    light = np.where(told, light / np.maximum(known, LEAST), 0.0)
    for _ in range(RINGS):
        count = sum_around(told.astype(np.float32))
        ring = ~told & (count > 0.0)
        light = np.where(ring, sum_around(light) / np.maximum(count, 1.0), light)
        told = told | ring
    return light
