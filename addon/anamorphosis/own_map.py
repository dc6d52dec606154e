"""The map of a mirror on an object's own mesh, no face of which is cut."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import PicturePieces, ReflectionError, breathe
from ...core.geometry import first_of, groups
from ..faults import AllOrNothing, Steps, keep_data
from ..reading import DiffuseScene
from ..writing import MOST_UV_MAPS
from .frame import Frame
from .sheet_arrays import SEEN, UV_MAP

CORNER = 1.0 - 1e-6     # weight from which on a corner of a piece is one of its triangle


@dataclass(frozen=True)
class OwnMap:
    """A map on an object's own mesh.

    Positions (n, 2) of the face corners in the view, and True (m,) for polygons that the mirror shows at least in part.
    Linear interpolation between the corners is wrong by up to `straying` pixels.
    """

    source: bpy.types.Object
    pixels: np.ndarray
    seen: np.ndarray
    straying: float


def own_map(index: int, scene: DiffuseScene, pieces: PicturePieces) -> OwnMap:
    """Return the map of the source `index` from its visible pieces.

    Visible corners get their position in the view. Others get the position from a linear extrapolation of their
    triangle's map.

    Raises
    ------
    ReflectionError
        If the object's own mesh is not what is reflected, or cannot hold another map.
    """
    source = scene.sources[index]
    triangles = np.flatnonzero(scene.source_object == index)
    corners, polygon = _own_triangles(source, len(triangles))
    in_source = np.flatnonzero(scene.source_object[pieces.face] == index)
    # for each triangle, the image that shows the largest part of it
    face = scene.source_face[pieces.face[in_source]]
    image = pieces.image[in_source]
    breathe()
    _, group = groups(face, image)
    breathe()
    area = np.abs(np.linalg.det(pieces.weights[in_source]))
    breathe()
    shown = np.bincount(group, area)[group]
    breathe()
    order = np.lexsort((image, -shown, face))
    breathe()
    first = order[first_of(face[order])[1]]
    best = np.full(len(triangles), -1)
    best[face[first]] = image[first]
    kept = in_source[best[face] == image]
    face = scene.source_face[pieces.face[kept]]
    weights, places = pieces.weights[kept], pieces.pixels[kept]
    breathe()
    fitted = _fitted(face, weights, places, len(triangles))
    pixels = np.full((len(source.data.loops), 2), np.nan)
    pixels[corners] = fitted
    breathe()
    piece, corner, which = np.nonzero(weights > CORNER)
    pixels[corners[face[piece], which]] = places[piece, corner]
    breathe()
    straying = np.linalg.norm(weights @ pixels[corners[face]] - places, axis=2).max(initial=0.0)
    seen = np.zeros(len(source.data.polygons), dtype=bool)
    seen[polygon[face]] = True
    return OwnMap(source, pixels, seen, float(straying))


def write_own_map(found: OwnMap, frame: Frame, whole: AllOrNothing) -> Steps[bpy.types.Object]:
    """Write the map, and a mark on the polygons that are seen, into the object's mesh; yields (fraction, "")."""
    keep_data(found.source, whole)
    yield 0.5, ""
    mesh = found.source.data
    layer = mesh.uv_layers.get(UV_MAP) or mesh.uv_layers.new(name=UV_MAP, do_init=False)
    layer.uv.foreach_set("vector", frame.uv(found.pixels).reshape(-1))
    mesh.uv_layers.active = layer
    earlier = mesh.attributes.get(SEEN)
    if earlier is not None:
        mesh.attributes.remove(earlier)
    mesh.attributes.new(SEEN, "BOOLEAN", "FACE").data.foreach_set("value", found.seen)
    mesh.update()
    return found.source


def _own_triangles(source: bpy.types.Object, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the loop indices (count, 3) and the polygon index (count,) of each triangle of a source's own mesh.

    Raises
    ------
    ReflectionError
        If the mesh cannot be written, or is not what was reflected, in `count` triangles.
    """
    if source.type != "MESH" or source.library is not None or source.is_instancer:
        raise ReflectionError(f"'{source.name}' has no mesh of its own that could be written: choose A Copy.")
    mesh = source.data
    mesh.calc_loop_triangles()
    if any(modifier.show_viewport for modifier in source.modifiers) or len(mesh.loop_triangles) != count:
        raise ReflectionError(f"'{source.name}' is reflected with its modifiers: apply them, or choose A Copy.")
    if UV_MAP not in mesh.uv_layers and len(mesh.uv_layers) >= MOST_UV_MAPS:
        raise ReflectionError(f"'{source.name}' has as many UV maps as a mesh can hold: remove one.")
    corners, polygon = np.empty((count, 3), dtype=np.int32), np.empty(count, dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", corners.reshape(-1))
    mesh.loop_triangles.foreach_get("polygon_index", polygon)
    return corners, polygon


def _fitted(face: np.ndarray, weights: np.ndarray, pixels: np.ndarray, count: int) -> np.ndarray:
    """Return pixel positions (count, 3, 2) of the corners of triangles, from linear maps fitted to their pieces; NaN
    for triangles without pieces.
    """
    share = np.repeat(np.abs(np.linalg.det(weights)) + 1e-12, 3)
    corners, places, owner = weights.reshape(-1, 3), pixels.reshape(-1, 2), np.repeat(face, 3)
    square, right = np.zeros((count, 3, 3)), np.zeros((count, 3, 2))
    breathe()
    np.add.at(square, owner, share[:, None, None] * corners[:, :, None] * corners[:, None])
    breathe()
    np.add.at(right, owner, share[:, None, None] * corners[:, :, None] * places[:, None])
    breathe()
    scale = np.trace(square, axis1=1, axis2=2)[:, None, None]
    has = np.flatnonzero(scale[:, 0, 0] > 0.0)
    fitted = np.full((count, 3, 2), np.nan)
    # least squares of the smallest norm: a sliver that is seen tells no place across it
    fitted[has] = np.linalg.pinv(square[has] / scale[has], rcond=1e-9) @ (right[has] / scale[has])
    return fitted
