"""Faces of a reflection that show the world: the parts of the mirror that the camera sees, behind all other faces.

A mirror shows the sky, and itself after the last bounce, wherever it shows none of the sources. With these faces a
reflection covers its mirror, which then need not be traced, or seen at all.
"""
from __future__ import annotations

import bpy
import numpy as np

from ...core import TriangleMesh, View, draw
from ...core.geometry import unit
from ...core.polygons import ConvexPolygons, Line
from ...core.result import GAP, place
from .. import compat
from ..reading import corner_vertices, join_mirror, mirrors_of, numbers, read_meshes, vectors
from ..writing import FIELDS, LATER_MATERIAL, NORMAL, place_of

WORLD = -1          # `source_object` of faces that show the world
NONE = -1           # among the materials of later mirrors
FAR = 1e4           # sizes of the mirror to the points that stand for directions
BORDER = 1.05       # of a picture's half width and height: faces reach so far
STRAYING = 0.1      # pixels by which the world may be shown beside its place
# number and type of the values of an attribute's elements
WIDTHS = {"FLOAT": (1, np.float32), "INT": (1, np.int32), "BOOLEAN": (1, bool), "FLOAT_VECTOR": (3, np.float32),
          "FLOAT2": (2, np.float32), "FLOAT_COLOR": (4, np.float32), "BYTE_COLOR": (4, np.float32)}
BEFORE_WORLD = 0.75     # of the smallest distance of other layers from the mirror: that of the world's layer
BEHIND = 1.05       # of the longest path: a virtual image of the world lies behind all others


def add_world_faces(mesh: bpy.types.Mesh, result: bpy.types.Object, view: View, hidden: bool) -> None:
    """Add faces to a reflection that show the world where `view` sees its mirror, unless it has some, or has points.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        Of that reflection, or a copy.
    hidden : bool
        Also where other faces of the reflection hide them all.
    """
    record, matrix = result.reflection_mesh, np.array(place_of(result), dtype=np.float64)
    positions = vectors(mesh, "position") @ matrix[:3, :3].T + matrix[:3, 3]
    if not len(mesh.polygons) or (numbers(mesh, "source_object") == WORLD).any() or lies_on_mirror(mesh, positions):
        return
    parts = mirrors_of(result)
    surface = join_mirror(read_meshes(bpy.context.evaluated_depsgraph_get(), parts, mirror=True), parts)
    chosen = _seen(view, surface.mesh, None if hidden else (positions, corner_vertices(mesh)))
    if not len(chosen):
        return
    part, weights = _in_the_view(view, surface.mesh.positions[surface.mesh.triangles[chosen]])
    chosen = chosen[part]
    corners, normals = (np.einsum("ikn,nix->nkx", weights, values[chosen]).reshape(-1, 3) for values in (
        surface.mesh.positions[surface.mesh.triangles], surface.mesh.corner_normals))
    # towards the eye, as a whole: beside an outline one of a face's corners may be turned away
    side = np.einsum("ni,ni->n", normals, view.directions(corners)).reshape(-1, 3).sum(axis=1)
    normals = np.where(np.repeat(side > 0.0, 3)[:, None], -normals, normals)
    # vertices of which faces have different normals are several
    own, faces = np.unique(np.column_stack((corners, normals.astype(np.float32))), axis=0, return_inverse=True)
    at, normals = own[:, :3], own[:, 3:]
    far = FAR * max(float(np.ptp(surface.mesh.positions, axis=0).max()), 1e-12)
    path = np.full(len(at), BEHIND * float(numbers(mesh, "path_length").max(initial=0.0)) if record.window else far)
    placement = "VIRTUAL" if record.window else "LAYERED"
    places = place(view, at.T, path, placement, far, _share(view, vectors(mesh, "mirror_position"), positions, at)).T
    matrix = np.linalg.inv(matrix)
    before = len(mesh.vertices), len(mesh.polygons)
    _extend(mesh, places @ matrix[:3, :3].T + matrix[:3, 3], faces.reshape(-1, 3))
    for name, values in (("mirror_position", at), ("reflected_position", world_targets(view, at, normals)),
                         ("path_length", path), ("image_parity", 1), (NORMAL, normals)):
        set_tail(mesh, name, before[0], values)
    # what later mirrors leave of the world's light is in the picture
    alone = [name for name in mesh.attributes.keys() if name.startswith(LATER_MATERIAL.format(""))]
    for name, values in (("source_object", WORLD), ("source_face", WORLD), ("bounces", 1),
                         ("mirror_face", surface.triangle[chosen]), *((name, NONE) for name in alone)):
        set_tail(mesh, name, before[1], values)


def _share(view: View, on_mirror: np.ndarray, positions: np.ndarray, at: np.ndarray) -> float:
    """Return the share of the usual gap before the mirror at which faces at places `at` (k, 3) are behind all others.

    Behind a pane close before the mirror, the others lie at a small share of the usual distance too. They are at
    `positions` (n, 3), and seen at places `on_mirror` (n, 3).
    """
    ahead = view.directions(on_mirror)
    before = np.einsum("ni,ni->n", on_mirror - positions, ahead) / np.einsum("ni,ni->n", ahead, ahead)
    size = np.ptp(at, axis=0).max() if view.orthographic else 1.0
    return float(np.clip(BEFORE_WORLD * before.min() / (GAP * size), 0.0, 1.0))


def _in_the_view(view: View, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the parts (n,) of triangles (m, 3, 3) that a view sees: which triangle each is of, and the weights
    (3, 3, n) of its corners, entry [i, k]: weight i of corner k. What lies behind the eye has no place in a picture."""
    x, y, _, w = np.moveaxis(view.clip(corners.reshape(-1, 3)).reshape(-1, 3, 4), (2, 1), (0, 1))
    parts = ConvexPolygons.whole(len(corners))
    for values in (BORDER * w - x, BORDER * w + x, BORDER * w - y, BORDER * w + y):
        parts = parts.cut(values, Line.HIDDEN)
    return parts.triangles(0.0)


def world_targets(view: View, at: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return points (n, 3) far away in the directions in which a mirror with `normals` (n, 3) shows the world at places
    `at` (n, 3). They change linearly along a flat mirror (unnormalised rays, DESIGN section 2)."""
    ahead, normals = view.directions(at), unit(normals.T).T
    return at + far_away(view) * (ahead - 2.0 * np.einsum("ni,ni->n", ahead, normals)[:, None] * normals)


def edges_off_world(mesh: bpy.types.Mesh, view: View, spots: np.ndarray) -> np.ndarray:
    """Let the vertices of faces that show the world show it exactly; return the edges (k,) along which a curved mirror
    turns light otherwise than between their ends, seen at `spots` (n, 2) in pixels, by more than `STRAYING`."""
    sky = numbers(mesh, "source_object") == WORLD
    if not sky.any() or NORMAL not in mesh.attributes:
        return np.empty(0, dtype=np.int64)
    own = np.zeros(len(mesh.vertices), dtype=bool)
    own[corner_vertices(mesh)[sky]] = True
    at, normals, targets = (vectors(mesh, name) for name in ("mirror_position", NORMAL, "reflected_position"))
    targets[own] = world_targets(view, at[own], normals[own])
    mesh.attributes["reflected_position"].data.foreach_set("vector", targets.astype(np.float32).reshape(-1))
    ends = np.empty((len(mesh.edges), 2), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends.reshape(-1))
    edges = np.flatnonzero(own[ends].all(axis=1))
    ends = ends[edges]
    middle = at[ends].mean(axis=1)
    true = world_targets(view, middle, normals[ends].mean(axis=1))
    # distances along the light path change nothing
    ahead = unit((true - middle).T).T
    off, change = (targets[ends].mean(axis=1) - true, targets[ends[:, 1]] - targets[ends[:, 0]])
    off, change = (np.linalg.norm(one - np.einsum("ni,ni->n", one, ahead)[:, None] * ahead, axis=1)
                   for one in (off, change))
    length = np.linalg.norm(spots[ends[:, 1]] - spots[ends[:, 0]], axis=1)
    return edges[off * length > STRAYING * change]


def far_away(view: View) -> float:
    """Return the factor from the directions of a view's rays to the points that stand for the world."""
    # an orthographic eye is as far away as its picture is wide
    return FAR / abs(view.projection[0, 0]) if view.orthographic else FAR


def lies_on_mirror(mesh: bpy.types.Mesh, positions: np.ndarray) -> bool:
    """Return True for a reflection on the mirror's own surface, which has no room for faces behind it."""
    on_mirror = vectors(mesh, "mirror_position")
    return bool((np.abs(positions - on_mirror) <= 1e-6 * np.abs(positions).max(initial=0.0)).all())


def _seen(view: View, mirror: TriangleMesh, hiding: tuple | None) -> np.ndarray:
    """Return the triangles of a mirror that a view sees, but for those that triangles (positions, corners) hide."""
    drawn = draw(view, mirror.positions, mirror.triangles).triangle
    if hiding is not None:
        covered = draw(view, *hiding).triangle >= 0
        drawn = np.where(_inner(covered.reshape(view.resolution[::-1])).reshape(-1), -1, drawn)
    seen = np.zeros(len(mirror.triangles), dtype=bool)
    seen[drawn[drawn >= 0]] = True
    # those beside them may be smaller than a pixel
    used = np.zeros(len(mirror.positions), dtype=bool)
    used[mirror.triangles[seen]] = True
    corners = mirror.positions[mirror.triangles]
    facing = np.einsum("ni,ni->n", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                       view.directions(corners.mean(axis=1)))
    # the side that is seen, by most of the seen triangles
    side = np.sign(facing[seen].sum()) if seen.any() else 1.0
    return np.flatnonzero(seen | used[mirror.triangles].any(axis=1) & (facing * side > 0.0))


def _inner(mask: np.ndarray) -> np.ndarray:
    """Return the pixels of a mask whose neighbours are all in it."""
    padded = np.pad(mask, 1, constant_values=False)
    height, width = mask.shape
    return np.logical_and.reduce([padded[y:y + height, x:x + width] for y in range(3) for x in range(3)])


def _extend(mesh: bpy.types.Mesh, positions: np.ndarray, corners: np.ndarray) -> None:
    """Add vertices (n, 3), triangles (m, 3) that number them, and their edges; earlier elements keep their attributes.

    Blender's own search for edges would remove their marks. Blender 5.2 ends where corners are added to a large mesh:
    there the mesh is built anew. New elements have attributes of zero.
    """
    vertices, edges, loops = len(mesh.vertices), len(mesh.edges), len(mesh.loops)
    sides = np.sort(np.stack((corners, np.roll(corners, -1, axis=1)), axis=2).reshape(-1, 2), axis=1)
    new_ends, side = np.unique(sides, axis=0, return_inverse=True)
    own_corners, own_edges = numbers(mesh, ".corner_vert"), numbers(mesh, ".corner_edge")
    ends = np.empty((edges, 2), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends.reshape(-1))
    if compat.adds_corners():
        kept = []
    else:
        kept = [(one.name, one.data_type, one.domain, _values(one)) for one in mesh.attributes
                if one.data_type in WIDTHS and not one.name.startswith(".")]
    active = mesh.uv_layers.active.name if mesh.uv_layers.active else ""
    rendered = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    colours = mesh.color_attributes.active_color_name, mesh.color_attributes.default_color_name
    if kept:
        mesh.clear_geometry()
    mesh.vertices.add(vertices + len(positions) - len(mesh.vertices))
    mesh.edges.add(edges + len(new_ends) - len(mesh.edges))
    mesh.loops.add(loops + corners.size - len(mesh.loops))
    mesh.polygons.add(loops // 3 + len(corners) - len(mesh.polygons))
    mesh.polygons.foreach_set("loop_start", np.arange(0, loops + corners.size, 3, dtype=np.int32))
    for name, values in ((".corner_vert", np.concatenate((own_corners, (vertices + corners).ravel()))),
                         (".corner_edge", np.concatenate((own_edges, edges + side.ravel())))):
        mesh.attributes[name].data.foreach_set("value", values.astype(np.int32))
    mesh.edges.foreach_set("vertices", np.concatenate((ends, vertices + new_ends)).astype(np.int32).reshape(-1))
    for name, kind, domain, values in kept:
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, domain)
        values = np.concatenate((values, np.zeros((len(attribute.data) - len(values), values.shape[1]), values.dtype)))
        attribute.data.foreach_set(FIELDS.get(kind, "value"), values.reshape(-1))
    set_tail(mesh, "position", vertices, positions)
    if kept:
        for layer in mesh.uv_layers:
            layer.active, layer.active_render = layer.name == active, layer.name == rendered
        mesh.color_attributes.active_color_name, mesh.color_attributes.default_color_name = colours
    mesh.update()


def _values(attribute: bpy.types.Attribute) -> np.ndarray:
    """Return the values (n, width) of an attribute."""
    width, kind = WIDTHS[attribute.data_type]
    values = np.empty((len(attribute.data), width), dtype=kind)
    attribute.data.foreach_get(FIELDS.get(attribute.data_type, "value"), values.reshape(-1))
    return values


def set_tail(mesh: bpy.types.Mesh, name: str, start: int, values) -> None:
    """Set the values of an attribute from one element on, where the mesh has it."""
    attribute = mesh.attributes.get(name)
    if attribute is None:
        return
    field, kind = FIELDS.get(attribute.data_type, "value"), np.int32 if attribute.data_type == "INT" else np.float32
    all_values = np.empty((len(attribute.data), 3 if field == "vector" else 1), dtype=kind)
    attribute.data.foreach_get(field, all_values.reshape(-1))
    all_values[start:] = np.reshape(values, (-1, all_values.shape[1]))
    attribute.data.foreach_set(field, all_values.reshape(-1))
