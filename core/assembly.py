"""Assembly: nodes and faces of all bounces as the plain arrays of the result.

A face shows the front of its source where the light left from there, and is turned towards the eye then: which sides
are fronts is told as in the scene, though what a mirror shows is turned over.
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

BESIDE = 1e-9  # of what is met: a corner that is farther from its source triangle lies beside it
OFF_MIRROR = 1e-6  # of the size of what is seen of it: how far from it a place may lie
CORNERS_AT_ONCE = 1 << 17  # before whoever waits has a turn
ON_CAUSTIC = 1e-5  # magnification below which bisection has put a node on the caustic


def assemble(view: View, bounces: list[Bounce], met: SceneAndMirrors, placement: str,
             whole: tuple[Seamed, float] | None = None, backward: dict | None = None) -> ReflectionMesh:
    """The faces as arrays, no two on the same nodes, without unused nodes: those of `bounces`, those drawn `whole` with
    the longest path by which they were told apart, and those made `backward`."""
    parts: list[dict] = []
    start, reach = 0, 0.0
    for number, bounce in enumerate(bounces, 1):
        mirror_map = bounces[0].cameras.mirror_map
        assert isinstance(mirror_map, MirrorMap)  # of the first bounce
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
    if backward is not None:
        parts.append({**backward, "triangles": backward["triangles"] + start})
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
    return ReflectionMesh(**arrays)


def _pad(parts: list[dict], name: str, value: float) -> None:
    """Let arrays whose second axis counts bounces have as many of them in all parts."""
    most = max(part[name].shape[1] for part in parts)
    for part in parts:
        own = part[name]
        missing = [(0, most - own.shape[1]) if axis == 1 else (0, 0) for axis in range(own.ndim)]
        part[name] = np.pad(own, missing, constant_values=value)


def _later_mirrors(maps: tuple, bounces: np.ndarray, map_face: np.ndarray, met: SceneAndMirrors) -> np.ndarray:
    """The triangles (m, b) of the mirrors, as given, that faces are seen by after the first one; -1 behind the last."""
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
    """The whole faces of the first bounce, behind the vertices of its others, of which `node` (n,) names the nodes."""
    count = len(whole.same)
    places, points = (np.concatenate(both, axis=1) for both in ((whole.place, bounce.nodes.place),
                                                                (whole.point, bounce.nodes.point)))
    sources = met.on_patch(whole.source)
    turned = _turned(mirror_map, whole.nodes, places, places,
                     rows(met.positions[met.triangles[sources].T]))
    nodes = np.where(turned[:, None], whole.nodes[:, [0, 2, 1]], whole.nodes)
    # vertices that the faces of cameras have already
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
    """The faces of a bounce, and the node that each vertex was."""
    frames, nodes, faces = bounce.frames, bounce.nodes, bounce.faces
    mirror_map = bounce.cameras.mirror_map
    # mirrors are seen by what they show
    faces = faces.select(~met.shows_mirror(frames)[faces.column])
    frames, faces = _on_whole_triangles(frames, faces, met)
    # doubled triangles of the scene, and polygons that fold flat, give the same face twice
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
    # a corner that was brought back to its triangle or to the mirror has left its ray by a little
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
    """The face of the map (f, 3) that each corner of the faces lies on, seen at (3, f, 3) places."""
    cameras, spanning = bounce.cameras, len(bounce.corner_face)
    face = np.repeat(cameras.face[faces.camera][:, None], 3, axis=1)
    chosen = np.flatnonzero(faces.camera >= len(cameras) - spanning)
    if len(chosen):
        camera = faces.camera[chosen]
        # their corners are those of their cameras, in whatever order
        same = (seen[:, chosen, :, None] == cameras.places[:, cameras.corners[camera]][:, :, None]).all(axis=0)
        face[chosen] = np.take_along_axis(bounce.corner_face[camera - len(cameras)], np.argmax(same, axis=2), axis=1)
    return face


def _turned(mirror_map: MirrorMap, nodes: np.ndarray, seen: np.ndarray, last: np.ndarray,
            corners: np.ndarray) -> np.ndarray:
    """Which faces (f, 3) are turned wrongly: to the eye where the back of their source is seen, or away where its front
    is.

    Parameters
    ----------
    seen, last : (3, n) float64
        Where the eye sees the nodes, and where the light met the last mirror on its way to them.
    corners : (3, 3, f) float64, of the sources' triangles, component and corner first
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
    """Unit normals (n, b, 3) of b mirrors, halfway between the ways of light to and from each: it is seen at (3, n)
    places of the first and goes on along `leaving`, (3, n) each."""
    ways = [mirror_map.view.directions(seen.T).T, *leaving]
    return np.stack([halfway(before, after).T for before, after in zip(ways, ways[1:])], axis=1)


def _on_whole_triangles(frames: SceneFrames, faces: Faces, met: SceneAndMirrors) -> tuple[SceneFrames, Faces]:
    """The faces with columns for the triangles that their pieces lie in."""
    if met.pieces is None:
        return frames, faces
    source, column = distinct(met.sources(frames.triangle[faces.column]))
    return SceneFrames.of(met, source), replace(faces, column=column)


def _on_sources(triangles: np.ndarray, column: np.ndarray, weights: np.ndarray, point: np.ndarray, frames: SceneFrames,
                met: SceneAndMirrors) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The faces (f, 3) with corners that lie on their source triangles, and of each vertex the one that it was, and its
    point (3, n).

    Straight outlines may leave a corner a fraction of a pixel beside its triangle, and neighbours of another source may
    share it: such a corner becomes a vertex of its own, in the same place of the picture, with the point of the rim.
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
    # a vertex that no face is left of goes; new ones stand where they come from
    kept, _ = distinct(corner)
    kept = kept[in_order(vertex[kept])]
    number = np.empty(len(vertex), dtype=np.int64)
    number[kept] = np.arange(len(kept))
    return number[corner].reshape(-1, 3), vertex[kept], point[:, kept]


def _on_mirror(mirror_map: MirrorMap, face: np.ndarray, triangles: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Places (3, n) of vertices, those that lie on the mirror triangle of no corner, `face` (3 f,), that is there
    brought back to it: an image may lie beside the mirror by as much as straight outlines may miss."""
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
