"""UV maps, colours and other attributes of a mirror on the result that lies on it, as the mirror's shader asks for
them."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import View, breathe, reflecting_normals
from ...core.trees import BoxTree, first_hits
from ..reading import DiffuseScene, corner_vertices, numbers, read_scene, seen_in, vectors
from ..reading.materials import reflecting_materials
from ..writing import FIELDS, LATER_MATERIAL, NORMAL
from .mirror_coordinates import BACK, GENERATED, OWN_NORMAL, OWN_PLACE, own_layer
from .several_materials import MATERIAL


def write_mirror_layers(mesh: bpy.types.Mesh, mirrors: list, view: View, asked: set[str]) -> None:
    """Write the layers of a result's mirrors at each corner of its mesh, those of the attributes that are `asked` for.

    A face lies in one triangle of the mirror, or over several: there those of its middle are carried on, so that no
    seam between islands runs through it.
    """
    own = {own_layer(name) for mirror in mirrors if mirror.type == "MESH" for name in mirror.data.attributes.keys()}
    by_part = {OWN_NORMAL, OWN_PLACE, own_layer(GENERATED)} if len(mirrors) > 1 else set()
    if not mirrors or asked.isdisjoint(own | by_part | {BACK, MATERIAL}):
        if mirrors:
            _write_own_space(mesh, mirrors, np.zeros(len(mesh.vertices), dtype=np.int64), asked)
        return
    known, is_seen = reflecting_materials(mirrors), seen_in(bpy.context)
    mirrors = [mirror for mirror in mirrors if is_seen(mirror)] or mirrors
    surface = read_scene(bpy.context.evaluated_depsgraph_get(), mirrors)
    corner_points = corner_vertices(mesh)
    places = vectors(mesh, "mirror_position")[corner_points]
    triangle = _triangles(mesh, surface, places, view)
    part = np.zeros(len(mesh.vertices), dtype=np.int64)
    part[corner_points] = surface.source_object[triangle][:, None]
    _write_own_space(mesh, mirrors, part, asked)
    corners = surface.mesh.positions[surface.mesh.triangles[triangle]]
    if BACK in asked:
        _, ahead = view.rays(view.pixels(places.mean(axis=1)))
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        _write(mesh, BACK, "FLOAT", "FACE", np.einsum("ni,ni->n", normals, ahead) > 0.0)
    if MATERIAL in asked:
        number = np.array([known.index(one) if one in known else 0 for one in surface.materials])
        _write(mesh, MATERIAL, "FLOAT", "FACE", number[surface.material[triangle]])
    weights = _barycentric(corners, places)
    for name, (kind, values) in _layers(surface):
        if own_layer(name) in asked:
            _write(mesh, own_layer(name), kind, "CORNER", np.matmul(weights, values[triangle]))


def _write_own_space(mesh: bpy.types.Mesh, mirrors: list, part: np.ndarray, asked: set[str]) -> None:
    """Tell each point of a result its mirror's normal, of any length, and its place in the mirror's own space; `part`
    (n,) numbers the mirrors."""
    to_world = np.array([mirror.matrix_world for mirror in mirrors], dtype=np.float64)
    if OWN_NORMAL in asked and NORMAL in mesh.attributes:
        turned = np.einsum("ni,nij->nj", vectors(mesh, NORMAL), to_world[part, :3, :3])
        _write(mesh, OWN_NORMAL, "FLOAT_VECTOR", "POINT", turned)
    if OWN_PLACE in asked:
        # a mirror of no thickness has no way back along it
        back = np.linalg.pinv(to_world[:, :3, :3])[part]
        own_place = np.einsum("nij,nj->ni", back, vectors(mesh, "mirror_position") - to_world[part, :3, 3])
        _write(mesh, OWN_PLACE, "FLOAT_VECTOR", "POINT", own_place)


def _write(mesh: bpy.types.Mesh, name: str, kind: str, domain: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, domain)
    attribute.data.foreach_set(FIELDS.get(kind, "value"), values.astype(np.float32).reshape(-1))


def _layers(surface: DiffuseScene):
    """Names, types and values (m, 3, c) of a mirror's layers at the corners of its triangles."""
    for name, values in surface.uv_maps.items():
        # no UV map: a result may have as many as there can be, and glTF and solid view would take one for the light
        yield name, ("FLOAT_VECTOR", _Padded(values))
    for name, (_, values) in surface.colours.items():
        yield name, ("FLOAT_COLOR", values)
    yield from surface.numbers.items()
    yield GENERATED, ("FLOAT_VECTOR", surface.generated)


class _Padded:
    """UV maps with a third component."""

    def __init__(self, values) -> None:
        self.values = values

    def __getitem__(self, chosen: np.ndarray) -> np.ndarray:
        return np.pad(self.values[chosen], ((0, 0), (0, 0), (0, 1)))


def _triangles(mesh: bpy.types.Mesh, surface: DiffuseScene, places: np.ndarray, view: View) -> np.ndarray:
    """The triangle (n,) of a mirror that each face lies in, with corners at `places` (n, 3, 3); the one in its middle
    where there are several."""
    triangle = numbers(mesh, "mirror_face")
    triangle = np.where(triangle < len(surface.mesh.triangles), triangle, -1)
    several = np.flatnonzero(triangle < 0)
    if len(several):
        origins, directions = view.rays(view.pixels(places[several].mean(axis=1)))
        met = first_hits(BoxTree.build(surface.mesh), origins.T, directions.T).triangle
        triangle[several] = np.maximum(met, 0)
    return triangle


def knows_mirror_normals(mesh: bpy.types.Mesh) -> bool:
    """Return True if a result stores the mirror's normal at each point, or positions that determine it."""
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


def _barycentric(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (n, k, 3), in the planes of triangles (n, 3, 3), of points (n, k, 3)."""
    breathe()
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    offset = points - corners[:, :1]
    aa, ab, bb = (np.einsum("ni,ni->n", x, y)[:, None] for x, y in ((a, a), (a, b), (b, b)))
    pa, pb = (np.einsum("nki,ni->nk", offset, side) for side in (a, b))
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (bb * pa - ab * pb) / (aa * bb - ab * ab)
        second = (aa * pb - ab * pa) / (aa * bb - ab * ab)
    return np.nan_to_num(np.stack((1.0 - first - second, first, second), axis=2), nan=1.0 / 3.0, posinf=0.0, neginf=0.0)
