"""What results tell of the objects that they show: how large, from where and from which side they are seen."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, View, breathe
from ...core.geometry import connected, distinct, doubled_areas, edge_numbers, first_of
from ..reading import DiffuseScene, corner_vertices, numbers, vectors
from .sight import places_of_sight

ONE_EYE = 0.2   # radians between how an object is seen and how from one place, from which on gloss would be wrong
SHARPEST = 0.9  # quantile of the pixels of an object that have no more than one texel
SOLID = 0.1     # of a closed object's picture: where fronts are more of it they hide the backs
HAIR = 0.01     # of an object's picture: what outlines show of a side that is hidden
OUTSIDE = 1e-6  # of a pixel that the camera sees: what one beside the picture tells
FEW = 16        # sources: each is baked by itself, and takes two seconds and more; a picture of all takes twenty
UNSEEN = 0.5    # of the others' middle density, where nothing of an object is seen


@dataclass(frozen=True)
class SeenSources:
    """By source of a joined scene, and by its triangles.

    Attributes
    ----------
    view : View
        By which.
    density : (k,) float64
        Pixels per unit of length at which a source is seen.
    seen_from : (k, 3) float64
        The place nearest to the lines along which the mirror sees it that shows most of it; the eye itself for what is
        not seen.
    one_eye : (k,) bool
        Whether all of it is seen nearly as from there: by flat mirrors exactly, by small or far ones as by holes.
    backs : (k,) bool
        Of which sources only backs are seen.
    both : (k,) bool
        Of which sources more than that is seen of both sides.
    """

    view: View
    density: np.ndarray
    seen_from: np.ndarray
    one_eye: np.ndarray
    backs: np.ndarray
    both: np.ndarray


def seen_sources(results: list, view: View, scene: DiffuseScene) -> SeenSources:
    """What `results`, which show `scene` to `view`, tell of its sources."""
    faces = [_faces(result, view, scene) for result in results]
    triangle, area, density, _, _, facing, _ = (np.concatenate(part) for part in zip(*faces, strict=True))
    breathe()
    count = len(scene.sources)
    owner = scene.source_object[triangle]
    later = [_shown_later(result, view, scene) for result in results]
    every, size, shows = (np.concatenate(part) for part in zip((owner, area, facing), *later, strict=True))
    fronts = np.bincount(every, weights=size * shows, minlength=count)
    whole = np.bincount(every, weights=size, minlength=count)
    seen_from, angle = _sight(faces, view, scene)
    return SeenSources(view, _densities(owner, density, area, count), seen_from, angle <= ONE_EYE,
                       fronts < SOLID * whole, (fronts > HAIR * whole) & (fronts < (1.0 - HAIR) * whole))


def _shown_later(result: bpy.types.Object, view: View, scene: DiffuseScene) -> tuple:
    """The source, the area in pixels and the side of each face of a result that several mirrors show."""
    mesh = result.data
    later = numbers(mesh, "bounces") > 1
    turned = doubled_areas(view.pixels(vectors(mesh, "mirror_position"))[corner_vertices(mesh)[later]])
    area = np.nan_to_num(0.5 * np.abs(turned), posinf=0.0)
    return scene.source_object[triangle_of(result, scene)[later]], area, turned > 0.0


def _sight(faces: list, view: View, scene: DiffuseScene) -> tuple[np.ndarray, np.ndarray]:
    """The place (k, 3) from which each source looks most nearly as it is seen, and how far that is (k,) from how it is,
    in the mirror that shows most of it: two mirrors see it from two places, and hardly as from one between."""
    count = len(scene.sources)
    places, angles, most = np.tile(np.asarray(view.eye, dtype=np.float64), (count, 1)), np.zeros(count), np.zeros(count)
    for triangle, area, _, eye, shown, _, inside in faces:
        owner = scene.source_object[triangle]
        # what the picture shows counts, and what may come into it where it shows nothing
        weight = area * np.where(inside, 1.0, OUTSIDE)
        whole = np.bincount(owner, weights=weight, minlength=count)
        middle = np.stack([np.bincount(owner, weights=weight * eye[:, axis], minlength=count) for axis in range(3)],
                          axis=1)
        start = np.where((whole > 0.0)[:, None], middle / np.where(whole > 0.0, whole, 1.0)[:, None], places)
        found, off = places_of_sight(owner, weight, shown, eye, start)
        more = whole > most
        places, angles = np.where(more[:, None], found, places), np.where(more, off, angles)
        most = np.maximum(whole, most)
    return places, angles


def fronts_seen(scene: DiffuseScene, triangle: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Whether what looks along -`towards` (n, 3) at triangles of the scene (n,) sees their fronts, (n,) bool."""
    corners = scene.mesh.positions[scene.mesh.triangles[triangle]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.einsum("ni,ni->n", normal, towards) > 0.0


def fronts_shown(mesh: bpy.types.Mesh, view: View, scene: DiffuseScene, triangle: np.ndarray) -> np.ndarray:
    """Whether faces of a result's mesh show the fronts of triangles of the scene (n,), (n,) bool. By how many mirrors
    ever, they turn their back to the eye where they show that of what is reflected; of one mirror the way tells."""
    corners, (at, shown) = corner_vertices(mesh), (vectors(mesh, name) for name in ("mirror_position",
                                                                                     "reflected_position"))
    once = fronts_seen(scene, triangle, (at - shown)[corners].mean(axis=1))
    return np.where(numbers(mesh, "bounces") == 1, once, doubled_areas(view.pixels(at)[corners]) > 0.0)


def has_rim(triangles: np.ndarray) -> bool:
    """Whether a surface of triangles (n, 3) ends somewhere."""
    edges = edge_numbers(triangles.astype(np.int64), np.roll(triangles, -1, axis=1), int(triangles.max(initial=0)) + 1)
    breathe()
    return bool((np.bincount(distinct(edges.ravel())[1]) == 1).any())


def outer_sides(positions: np.ndarray, triangles: np.ndarray) -> tuple[bool, bool]:
    """Whether some shells of a surface without a rim, triangles (n, 3), have their fronts outside, and whether some
    have their backs there: what is seen of a shell from outside hides the rest of it."""
    shell = connected(triangles.astype(np.int64))
    breathe()
    # from a corner of its own a small shell far away has a volume that rounding does not turn over
    corners = positions[triangles] - positions[triangles[first_of(shell)[1][shell], :1]]
    volume = np.bincount(shell, np.linalg.det(corners))
    return bool((volume >= 0.0).any()), bool((volume < 0.0).any())


def can_be_baked(results: list) -> bool:
    """Whether all of `results` have faces that know what they show, and it is still there."""
    return all(len(result.data.polygons) and "source_face" in result.data.attributes
               and result.reflection_mesh.mirror is not None
               and all(entry.object is not None for entry in result.reflection_mesh.sources) for result in results)


def are_few(results: list) -> bool:
    """Whether what `results` show is baked in a while."""
    return len({entry.object for result in results for entry in result.reflection_mesh.sources}) <= FEW


def triangle_of(result: bpy.types.Object, scene: DiffuseScene) -> np.ndarray:
    """The triangle of the scene that each face of a result shows, (n,) int64; sources are found by the pointers that
    the result keeps.

    Raises
    ------
    ReflectionError
        Where one of them does not take part in the scene.
    """
    triangle = triangles_in(result, result.data, scene)
    if (triangle < 0).any():
        raise ReflectionError(f"'{result.name}' shows an object that is hidden now: show it, or generate the "
                              "reflection again.")
    return triangle


def triangles_in(result: bpy.types.Object, mesh: bpy.types.Mesh, scene: DiffuseScene) -> np.ndarray:
    """As `triangle_of`, with -1 where a source does not take part, or has fewer triangles now; the `mesh` may be
    another than the result's own."""
    index = {source: number for number, source in enumerate(scene.sources)}
    table = np.array([index.get(entry.object, -1) for entry in result.reflection_mesh.sources], dtype=np.int64)
    owner, face = table[numbers(mesh, "source_object")], numbers(mesh, "source_face")
    parts = triangles_by_source(scene)
    counts = np.array([len(part) for part in parts])
    there = (owner >= 0) & (face < counts[owner])
    return np.where(there, np.concatenate(parts)[np.where(there, (np.cumsum(counts) - counts)[owner] + face, 0)], -1)


def triangles_by_source(scene: DiffuseScene) -> list:
    """The triangles of each source of a scene, in their own order, as indices (n,) into the scene's."""
    order = np.lexsort((scene.source_face, scene.source_object))
    return np.split(order, np.searchsorted(scene.source_object[order], np.arange(1, len(scene.sources))))


def weights_of(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (n, k, 3), none negative, in triangles (n, 3, 3) of the points (n, k, 3) nearest."""
    weights = np.maximum(barycentric(corners, points), 0.0)
    return weights / np.maximum(weights.sum(axis=2, keepdims=True), 1e-12)


def barycentric(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
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


def _faces(result: bpy.types.Object, view: View, scene: DiffuseScene) -> tuple:
    """Triangle of the scene, area in pixels, pixels per unit, mirrored eye, middle and side of each face of a result
    that one mirror shows, and whether it is in the picture."""
    mesh = result.data
    once = numbers(mesh, "bounces") == 1
    corners, triangle = corner_vertices(mesh)[once], triangle_of(result, scene)[once]
    shown, mirror = vectors(mesh, "reflected_position"), vectors(mesh, "mirror_position")
    spots = view.pixels(mirror)[corners]
    sides = spots[:, (1, 2, 0)] - spots
    area = 0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    points, at = shown[corners], mirror[corners].mean(axis=1)
    lengths = np.linalg.norm(points[:, (1, 2, 0)] - points, axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        density = np.nan_to_num(np.linalg.norm(sides, axis=2).max(axis=1) / lengths.max(axis=1), posinf=0.0)
    breathe()
    middle = points.mean(axis=1)
    towards = at - middle
    path = np.linalg.norm(towards, axis=1, keepdims=True)
    far = path + np.linalg.norm(at - view.eye, axis=1, keepdims=True)
    eye = middle + towards * (far / np.maximum(path, 1e-12))
    facing = fronts_seen(scene, triangle, towards)
    usable = np.isfinite(area) & np.isfinite(density)
    inside = ((spots.mean(axis=1) > 0.0) & (spots.mean(axis=1) < view.resolution)).all(axis=1)
    return triangle, np.where(usable, area, 0.0), density, eye, middle, facing, inside


def _densities(owner: np.ndarray, density: np.ndarray, area: np.ndarray, count: int) -> np.ndarray:
    """The quantile `SHARPEST` of each source's density, pixel by pixel."""
    found = np.zeros(count)
    order = np.lexsort((density, owner))
    ranked, weight = owner[order], area[order]
    starts = np.searchsorted(ranked, np.arange(count + 1))
    for number in range(count):
        part = slice(starts[number], starts[number + 1])
        summed = np.cumsum(weight[part])
        if len(summed) and summed[-1] > 0.0:
            found[number] = density[order][part][np.searchsorted(summed, SHARPEST * summed[-1])]
    seen = found > 0.0
    return np.where(seen, found, UNSEEN * np.median(found[seen]) if seen.any() else 1.0)
