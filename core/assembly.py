"""Assembly: nodes and faces of all bounces as the plain arrays of the result.

A face of the result is front-facing to the eye if the light left the front side of its source triangle. Front and
back are those of the scene, although a mirror image reverses the winding order.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from .bounce import Bounce
from .cameras import MirrorMap, brought_back, distance_from
from .culling import SceneAndMirrors
from .geometry import SceneFrames, area_normals, columns, distinct, dot, doubled_areas, groups, in_order, norm, rows
from .polygons import Faces
from .result import ReflectionMesh, halfway, place
from .support import breathe, portions
from .views import LampView, View
from .whole_faces import Seamed

BESIDE = 1e-9  # share of the sources' bounding box: a corner farther from its source triangle lies outside of it
OFF_MIRROR = 1e-6  # share of the visible mirror's bounding box: largest distance of a vertex from its mirror triangle
CORNERS_AT_ONCE = 1 << 17  # corners per chunk, between two cooperative yields
ON_CAUSTIC = 1e-5  # magnification below which bisection has put a node on the caustic


def assemble(view: View, bounces: list[Bounce], met: SceneAndMirrors, placement: str,
             whole: tuple[Seamed, float] | None = None, backward: dict | None = None) -> ReflectionMesh:
    """Join all faces of the reflection into one `ReflectionMesh`, without duplicate faces and without unused vertices.

    Parameters
    ----------
    bounces : list of Bounce, faces made by cameras, the first bounce first
    met : SceneAndMirrors
    placement : str, one of `PLACEMENTS`
    whole : (Seamed, float), optional
        Unclipped triangles of the first bounce, and the longest path length that was assumed for their depth order.
    backward : dict, optional, arrays of the faces made by rays from the eye
    """
    parts: list[dict] = []
    start, reach = 0, 0.0
    for number, bounce in enumerate(bounces, 1):
        mirror_map = bounces[0].cameras.mirror_map
        assert isinstance(mirror_map, MirrorMap)  # the first bounce has no other map
        part, node = _arrays(mirror_map, bounce, met)
        part["bounces"] = np.full(len(part["triangles"]), number, dtype=np.int8)
        part["triangles"] = part["triangles"] + start
        start += len(part["path_length"])
        parts.append(part)
        breathe()
        if whole is not None and number == 1:
            seams, reach = whole
            parts.append(_whole_arrays(mirror_map, seams, bounce, node, met))
            start += len(parts[-1]["path_length"])
    maps = tuple(bounce.cameras.mirror_map for bounce in bounces)
    for part in parts:
        part["later_mirrors"] = _later_mirrors(maps, part["bounces"], part["map_face"], met)
    lift = np.zeros(0)
    if backward is not None:
        lift = np.concatenate((np.zeros(start), backward["lift"]))
        parts.append({name: values for name, values in backward.items() if name != "lift"})
        parts[-1]["triangles"] = backward["triangles"] + start
    _pad(parts, "mirror_normals", 0.0)
    _pad(parts, "later_mirrors", -1)
    breathe()
    arrays = {name: np.concatenate([part.pop(name) for part in parts]) for name in tuple(parts[0])}
    breathe()
    map_face = arrays.pop("map_face")
    if isinstance(view, LampView):
        arrays["positions"] = arrays["mirror_position"]
        return ReflectionMesh(**arrays, maps=maps, map_face=map_face)
    arrays["positions"] = place(view, arrays["mirror_position"].T, arrays["path_length"], placement, reach,
                                met.slide).T
    if placement == "LAYERED" and lift.any():
        nearer = lift if view.orthographic else lift / (1.0 + lift)
        arrays["positions"] -= nearer[:, None] * view.directions(arrays["positions"])
    return ReflectionMesh(**arrays)


def _pad(parts: list[dict], name: str, value: float) -> None:
    """Pad the array `name` of all parts in place with `value`, to the same length of its second axis (bounces)."""
    most = max(part[name].shape[1] for part in parts)
    for part in parts:
        own = part[name]
        missing = [(0, most - own.shape[1]) if axis == 1 else (0, 0) for axis in range(own.ndim)]
        part[name] = np.pad(own, missing, constant_values=value)


def _later_mirrors(maps: tuple, bounces: np.ndarray, map_face: np.ndarray, met: SceneAndMirrors) -> np.ndarray:
    """Return the indices (m, b) of the mirror triangles that reflect each face after the first mirror; -1 if none.

    Parameters
    ----------
    maps : tuple of ReflectionMap, one for each bounce
    bounces : (m,) int, number of bounces of each face
    map_face : (m,) int64, face of its bounce's map that each face is seen in
    met : SceneAndMirrors, maps to the indices of the input mirrors
    """
    later = np.full((len(map_face), max(len(maps) - 1, 0)), -1)
    for number, ray_map in enumerate(maps, 1):
        chosen = np.flatnonzero(bounces == number)
        face = map_face[chosen]
        for before in range(number - 2, -1, -1):
            later[chosen, before] = met.given[ray_map.triangle[face]]
            face, ray_map = ray_map.face_before[face], ray_map.before
    return later


def _whole_arrays(mirror_map: MirrorMap, whole: Seamed, bounce: Bounce, node: np.ndarray,
                  met: SceneAndMirrors) -> dict:
    """Return the result arrays of the unclipped triangles of the first bounce.

    Their vertex indices continue after the n vertices of the bounce's other faces; `node` (n,) holds the indices of the
    nodes that those vertices were made from.
    """
    count = len(whole.same)
    places, points = (np.concatenate(both, axis=1) for both in ((whole.place, bounce.nodes.place),
                                                                (whole.point, bounce.nodes.point)))
    sources = met.on_patch(whole.source)
    turned = _turned(mirror_map, whole.nodes, places, places,
                     rows(met.positions[met.triangles[sources].T]))
    nodes = np.where(turned[:, None], whole.nodes[:, [0, 2, 1]], whole.nodes)
    # reuse vertices that the faces of cameras have already
    vertex_of = np.full(places.shape[1], -1)
    vertex_of[count + node[::-1]] = np.arange(len(node))[::-1]
    shared = np.flatnonzero(whole.same >= 0)
    vertex_of[shared] = vertex_of[count + whole.same[shared]]
    used = np.zeros(len(vertex_of), dtype=bool)
    used[nodes.ravel()] = True
    new = np.flatnonzero(used & (vertex_of < 0))
    vertex_of[new] = len(node) + np.arange(len(new))
    place, point = places[:, new], points[:, new]
    weights = np.where(turned[:, None, None], np.eye(3)[[0, 2, 1]], np.eye(3))
    part = np.flatnonzero(whole.split)
    if len(part):
        source, column = distinct(sources[part])
        frames = SceneFrames.of(met, source)
        own = frames.weights_within(np.repeat(column, 3), points[:, nodes[part].ravel()])
        weights[part] = own.T.reshape(-1, 3, 3)
    return {
        "triangles": vertex_of[nodes], "reflected_position": point.T, "mirror_position": place.T,
        "path_length": norm(point - place), "image_parity": np.ones(len(new), dtype=np.int8),
        "mirror_normals": _mirror_normals(mirror_map, place, [point - place]),
        "source_face": whole.source, "source_weights": weights, "mirror_face": whole.mirror_face,
        "map_face": whole.mirror_face,
        "bounces": np.ones(len(nodes), dtype=np.int8)}


def _arrays(first_map: MirrorMap, bounce: Bounce, met: SceneAndMirrors) -> tuple[dict, np.ndarray]:
    """Return the result arrays of a bounce's faces, and the index (n,) of the node that each vertex was made from."""
    frames, nodes, faces = bounce.frames, bounce.nodes, bounce.faces
    mirror_map = bounce.cameras.mirror_map
    # drop faces whose source is a mirror: the next bounce shows their reflection instead
    faces = faces.select(~met.shows_mirror(frames)[faces.column])
    frames, faces = _on_whole_triangles(frames, faces, met)
    # drop duplicate faces, which come from duplicate triangles of the scene and from polygons that fold flat
    once, _ = groups(*np.sort(faces.nodes, axis=1).T)
    faces = faces.select(np.sort(once))
    used, corner = distinct(faces.nodes.ravel())
    triangles = corner.reshape(-1, 3)
    seen, point = nodes.place[:, used], nodes.point[:, used]
    column = np.repeat(faces.column, 3)
    breathe()
    weights = frames.weights_within(column, np.take(point, corner, axis=1))
    triangles, vertex, point = _on_sources(triangles, column, weights, point, frames, met)
    used, seen = used[vertex], seen[:, vertex]
    breathe()

    face = bounce.cameras.face[faces.camera]
    corner_face = _corner_faces(bounce, faces, seen[:, triangles])
    owner = np.zeros(len(used), dtype=np.int64)
    owner[triangles.ravel()] = corner_face.ravel()
    breathe()
    seen = _on_mirror(first_map, mirror_map.first(corner_face.ravel()), triangles, seen)
    uv = mirror_map.coordinates(owner, seen)
    breathe()
    turned = mirror_map.turned(owner, uv, nodes.distance[used])
    breathe()
    # corners moved back to their triangle or to the mirror lie slightly off their ray: measure the path by its points
    mirrors = [seen, *mirror_map.met_later(owner, uv)]
    stops = [*mirrors, point]
    corners = rows(met.positions[frames.vertices[:, faces.column]])
    breathe()
    swapped = _turned(first_map, triangles, seen, mirrors[-1], corners)
    breathe()
    order = np.where(swapped[:, None], (0, 2, 1), (0, 1, 2))
    triangles = np.take_along_axis(triangles, order, axis=1)
    weights = np.take_along_axis(weights.T.reshape(-1, 3, 3), order[:, :, None], axis=1)
    breathe()
    path = np.maximum(sum(norm(end - start) for start, end in zip(stops, stops[1:])), norm(point - seen))
    return {
        "triangles": triangles, "reflected_position": point.T, "mirror_position": seen.T, "path_length": path,
        "image_parity": np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned)).astype(np.int8),
        "mirror_normals": _mirror_normals(first_map, seen, mirror_map.leaving(owner, uv)),
        "source_face": met.of_scene(frames.triangle[faces.column]),
        "source_weights": weights,
        "mirror_face": np.where((corner_face == face[:, None]).all(axis=1), mirror_map.first(face), -1),
        "map_face": face}, used


def _corner_faces(bounce: Bounce, faces: Faces, seen: np.ndarray) -> np.ndarray:
    """Return the indices (f, 3) of the map's faces that the corners of the f faces lie on.

    `seen` (3, f, 3) holds the corners' places on the mirror, as [component, face, corner].
    """
    cameras, spanning = bounce.cameras, len(bounce.corner_face)
    face = np.repeat(cameras.face[faces.camera][:, None], 3, axis=1)
    chosen = np.flatnonzero(faces.camera >= len(cameras) - spanning)
    if len(chosen):
        camera = faces.camera[chosen]
        # these faces have the corners of their cameras, possibly in another order
        same = (seen[:, chosen, :, None] == cameras.places[:, cameras.corners[camera]][:, :, None]).all(axis=0)
        face[chosen] = np.take_along_axis(bounce.corner_face[camera - len(cameras)], np.argmax(same, axis=2), axis=1)
    return face


def _turned(mirror_map: MirrorMap, nodes: np.ndarray, seen: np.ndarray, last: np.ndarray,
            corners: np.ndarray) -> np.ndarray:
    """Return True (f,) for faces with the wrong winding order.

    The order is wrong if a face is front-facing to the eye although the back of its source is seen, or back-facing
    although the source's front is seen.

    Parameters
    ----------
    nodes : (f, 3) int64, vertices of the faces
    seen, last : (3, n) float64
        Vertices on the first mirror, where the eye sees them, and on the last mirror, where the light met it.
    corners : (3, 3, f) float64, corners of the source triangles, as [component, corner, face]
    """
    away = doubled_areas(mirror_map.view.pixels(seen.T)[nodes]) < 0.0
    breathe()
    normals = area_normals(corners)
    height = np.zeros(len(nodes))
    for corner, node in enumerate(nodes.T):
        breathe()
        height += dot(normals, columns(last, node) - corners[:, corner])
    return away != (height < 0.0)


def _mirror_normals(mirror_map: MirrorMap, seen: np.ndarray, leaving: list[np.ndarray]) -> np.ndarray:
    """Return unit normals (n, b, 3) of the b mirrors: the half vectors of the arriving and the leaving ray.

    `seen` (3, n) are places on the first mirror; `leaving` holds the ray directions (3, n) after each mirror.
    """
    ways = [mirror_map.view.directions(seen.T).T, *leaving]
    return np.stack([halfway(before, after).T for before, after in zip(ways, ways[1:])], axis=1)


def _on_whole_triangles(frames: SceneFrames, faces: Faces, met: SceneAndMirrors) -> tuple[SceneFrames, Faces]:
    """Return frames of the whole source triangles, and the faces with their `column` indices changed to these frames.

    Pieces of split triangles are replaced by the triangles that they lie in.
    """
    if met.pieces is None:
        return frames, faces
    source, column = distinct(met.sources(frames.triangle[faces.column]))
    return SceneFrames.of(met, source), replace(faces, column=column)


def _on_sources(triangles: np.ndarray, column: np.ndarray, weights: np.ndarray, point: np.ndarray, frames: SceneFrames,
                met: SceneAndMirrors) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Move reflected points onto their source triangles, and split vertices that several sources share.

    Straight outlines may leave a corner a fraction of a pixel outside of its triangle, and faces of another source may
    share it. Such a corner becomes a vertex of its own, at the same place in the picture, with a point on the border of
    its triangle.

    Parameters
    ----------
    triangles : (f, 3) int64, vertices of the faces
    column : (3 f,) int64, column of `frames` with the source of each corner
    weights : (3, 3 f) float64, barycentric coordinates of each corner within its source
    point : (3, n) float64, reflected points of the vertices, in world space

    Returns
    -------
    triangles : (f, 3) int64, new vertices of the faces
    vertex : (k,) int64, the old vertex that each new one comes from
    point : (3, k) float64, reflected points of the new vertices
    """
    corner = triangles.ravel()
    own = np.empty((3, len(corner)))
    for some in portions(len(corner), CORNERS_AT_ONCE):
        own[:, some] = (rows(met.positions[frames.vertices[:, column[some]]]) * weights[:, some]).sum(axis=1)
    size = np.ptp(met.positions[frames.vertices.ravel()], axis=0).max() if len(corner) else 0.0
    beside = np.flatnonzero(norm(own - point[:, corner]) > BESIDE * size)
    breathe()
    first, group = groups(corner[beside], column[beside])
    count, corner = point.shape[1], corner.copy()
    vertex = np.concatenate((np.arange(count), corner[beside[first]]))
    point = np.concatenate((point, own[:, beside[first]]), axis=1)
    corner[beside] = count + group
    # drop unused vertices; sort the new ones by the vertex that they come from
    kept, _ = distinct(corner)
    kept = kept[in_order(vertex[kept])]
    number = np.empty(len(vertex), dtype=np.int64)
    number[kept] = np.arange(len(kept))
    return number[corner].reshape(-1, 3), vertex[kept], point[:, kept]


def _on_mirror(mirror_map: MirrorMap, face: np.ndarray, triangles: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Move vertices that lie off the mirror back onto it, and return the places (3, n) of all vertices.

    An image may lie outside of the mirror by the error of straight outlines.

    Parameters
    ----------
    mirror_map : MirrorMap
    face : (3 f,) int64, mirror triangle of each corner of the faces
    triangles : (f, 3) int64, vertices of the faces
    seen : (3, n) float64, places of the vertices, in world space
    """
    if not len(face):
        return seen
    owner = np.zeros(seen.shape[1], dtype=np.int64)
    owner[triangles.ravel()] = face
    room = OFF_MIRROR * np.ptp(seen, axis=1).max()
    breathe()
    off = distance_from(mirror_map, owner, seen) > room
    breathe()
    corner = np.flatnonzero(off[triangles.ravel()])
    if not len(corner):
        return seen
    vertex = triangles.ravel()[corner]
    moved, away = brought_back(mirror_map, face[corner], seen[:, vertex])
    order = np.lexsort((away, vertex))
    order = order[np.flatnonzero(np.diff(vertex[order], prepend=-1))]
    order = order[norm(moved[:, order] - seen[:, vertex[order]]) > room]
    seen = seen.copy()
    seen[:, vertex[order]] = moved[:, order]
    return seen
