"""Where the points of a reflection mesh lie: on their source triangles, on the mirror, and on the true rays."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from core import ReflectionMesh, TriangleMesh, View
from tests.fuzz.drawing.configurations import Configuration
from tests.oracles.truth import reflected_rays

ON_SOURCE = 1e-6  # of the scene's size
ON_MIRROR = 1e-5  # of the scene's size
ON_TRIANGLE, MORE = 2.0, 2.0  # pixels and tolerances between a corner and the mirror's triangle that its face names
SAMPLE = 300  # corners of faces
LEAST_AREA = 0.3  # pixels: faces below show nothing
TOLERANCES, FEWEST = 5.0, 10  # by which one ray in ten may miss, of as many at least
STEP = 0.02  # pixels between the rays that tell the motion per pixel
ROUNDING = 1e-7  # of the scene's size: a miss below is none
NEAREST = 1e-6  # of what is farthest: a depth before the eye
EDGE_ON = 0.02  # sine at which a ray meets its source: what is seen flatter shows its outline only


def on_source(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """Every corner of every face shows the point of its source triangle that its weights name; a disc its vertex."""
    scene = configuration.scene
    if mesh.discs is not None:
        named, shown = scene.positions[mesh.discs.source_vertex], mesh.reflected_position
    else:
        named = np.einsum("fck,fkx->fcx", mesh.source_weights, scene.positions[scene.triangles[mesh.source_face]])
        shown = mesh.reflected_position[mesh.triangles]
    off = np.linalg.norm(named - shown, axis=-1) / configuration.size
    if off.size and off.max() > ON_SOURCE:
        yield (f"source: {np.count_nonzero(off > ON_SOURCE)} of {off.size} points are up to {off.max():.3g} of the "
               "scene off their source")


def on_mirror(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """Every point lies on the mirror, and in the picture not far from the triangle of it that its face names."""
    corners, size = configuration.mirror.positions[configuration.mirror.triangles], configuration.size
    if mesh.discs is not None:
        named, point = mesh.discs.mirror_face, np.arange(len(mesh.positions))
    else:
        known = mesh.mirror_face >= 0
        named, point = np.repeat(mesh.mirror_face[known], 3), mesh.triangles[known].ravel()
    place = mesh.mirror_position[point]
    on_triangle = nearest_points(corners[named], place)
    off = np.linalg.norm(on_triangle - place, axis=1) > ON_MIRROR * size
    beside = _pixels_beside(configuration.view, corners[named], place)
    far = off & ~(beside <= ON_TRIANGLE + MORE * configuration.settings.tolerance)
    if far.any():
        yield (f"named: {np.count_nonzero(far)} of {len(far)} corners lie up to {beside[far].max():.3g} px beside the "
               "mirror's triangle that they name")
    unsure = np.setdiff1d(np.arange(len(mesh.positions)), point[~off])
    if len(unsure):
        place = mesh.mirror_position[unsure]
        found = (nearest_points(np.broadcast_to(corner, (len(place), 3, 3)), place) for corner in corners)
        away = np.min([np.linalg.norm(one - place, axis=1) for one in found], axis=0) / size
        if away.max() > ON_MIRROR:
            yield (f"mirror: {np.count_nonzero(away > ON_MIRROR)} of {len(mesh.positions)} points lie up to "
                   f"{away.max():.3g} of the scene off the mirror")


def _pixels_beside(view: View, corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """How far in the picture (n,) places (n, 3) are from triangles (n, 3, 3), whose picture is that of what lies before
    the eye; NaN where that is nothing."""
    before = _before_eye(view, corners)
    flat, spots = (np.pad(view.pixels(points.reshape(-1, 3)), ((0, 0), (0, 1))) for points in (before, places))
    pictures = flat.reshape(len(places), 2, 3, 3)
    return np.min([np.linalg.norm(nearest_points(pictures[:, k], spots) - spots, axis=1) for k in (0, 1)], axis=0)


def _before_eye(view: View, corners: np.ndarray) -> np.ndarray:
    """Two triangles (n, 2, 3, 3) that make up what of each one (n, 3, 3) lies before the eye; NaN if nothing does."""
    depth = view.depths(corners.reshape(-1, 3)).reshape(-1, 3)
    nearest = NEAREST * np.abs(depth).max(axis=1, initial=0.0, keepdims=True)
    ahead = depth > nearest
    several = ahead.sum(axis=1) >= 2
    # the corner that is alone on its side comes first
    order = (np.argmax(ahead != several[:, None], axis=1)[:, None] + np.arange(3)) % 3
    a, b, c = np.moveaxis(np.take_along_axis(corners, order[..., None], axis=1), 1, 0)
    turned = np.take_along_axis(depth, order, axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        share = ((turned[:, :1] - nearest) / (turned[:, :1] - turned[:, 1:]))[..., None]
        ab, ac = a + share[:, 0] * (b - a), a + share[:, 1] * (c - a)
    alone, cut = np.stack((a, ab, ac), axis=1), np.stack((np.stack((ab, b, c), 1), np.stack((ab, c, ac), 1)), axis=1)
    found = np.where(several[:, None, None, None], cut, alone[:, None])
    found[ahead.all(axis=1)] = corners[ahead.all(axis=1), None]
    found[~ahead.any(axis=1)] = np.nan
    return found


def nearest_points(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The points (n, 3) of triangles, `corners` (n, 3, 3), nearest to `points` (n, 3)."""
    way = np.roll(corners, -1, axis=1) - corners
    offset = points[:, None] - corners
    share = np.clip((offset * way).sum(axis=2) / np.maximum((way**2).sum(axis=2), 1e-300), 0.0, 1.0)
    rim = corners + share[:, :, None] * way
    one = np.linalg.norm(rim - points[:, None], axis=2).argmin(axis=1)
    rim = np.take_along_axis(rim, one[:, None, None], axis=1)[:, 0]
    normal = np.cross(way[:, 0], -way[:, 2])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(length > 0.0, length, 1.0)
    inside = (np.cross(way, offset) * normal[:, None]).sum(axis=2) >= 0.0
    below = points - (offset[:, 0] * normal).sum(axis=1, keepdims=True) * normal
    return np.where(inside.all(axis=1, keepdims=True) & (length > 0.0), below, rim)


def on_rays(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """The ray that the mirror reflects at a corner passes the diffuse point that the corner shows."""
    if configuration.settings.method == "PARALLEL":
        return
    miss = misses(configuration, mesh)
    allowed = TOLERANCES * configuration.settings.tolerance
    if len(miss) >= FEWEST and np.percentile(miss, 90) > allowed:
        yield (f"rays: one corner in ten is {np.percentile(miss, 90):.3g} px off, {miss.max():.3g} px at most, "
               f"where {allowed:g} are allowed")


def misses(configuration: Configuration, mesh: ReflectionMesh) -> np.ndarray:
    """By how many pixels true rays through some corners miss what the corners show, after one bounce."""
    view, mirror = configuration.view, configuration.mirror
    point, face = _some_corners(view, mesh)
    triangle = mesh.discs.mirror_face[point] if mesh.discs is not None else mesh.mirror_face[face]
    pixel, shown = view.pixels(mesh.mirror_position[point]), mesh.reflected_position[point]
    length = np.linalg.norm(shown - mesh.mirror_position[point], axis=1)[:, None]

    def landed(step) -> tuple[np.ndarray, ...]:
        place, ray, _ = reflected_rays(mirror, triangle, *view.rays(pixel + step))
        return place + length * ray, ray, place
    end, ray, place = landed((0.0, 0.0))
    motion = np.zeros(len(point))
    for step in ((STEP, 0.0), (0.0, STEP)):
        motion = np.maximum(motion, np.linalg.norm(across(landed(step)[0] - end, ray), axis=1) / STEP)
    miss = np.linalg.norm(across(shown - end, ray), axis=1)
    behind = ((shown - place) * ray).sum(axis=1) < -ROUNDING * configuration.size
    miss = np.where(behind, np.linalg.norm(shown - place, axis=1), miss)
    pixels = np.where(miss < ROUNDING * configuration.size, 0.0, miss / np.maximum(motion, 1e-300))
    told = ~bent(mirror, triangle, view.directions(place), ray)
    if mesh.discs is None:
        told &= np.abs((configuration.scene.face_normals()[mesh.source_face[face]] * ray).sum(axis=1)) > EDGE_ON
    return pixels[told]


def across(ways: np.ndarray, ray: np.ndarray) -> np.ndarray:
    """The part of `ways` (n, 3) at right angles to unit vectors `ray` (n, 3)."""
    return ways - (ways * ray).sum(axis=1, keepdims=True) * ray


def _some_corners(view: View, mesh: ReflectionMesh) -> tuple[np.ndarray, np.ndarray]:
    """Points in the picture and their faces, after one bounce, of faces that show something in one of the mirror's
    triangles."""
    rng = np.random.default_rng(1)
    pixels = view.pixels(mesh.mirror_position)
    inside = ((pixels >= 0.0) & (pixels <= view.resolution)).all(axis=1)
    if mesh.discs is not None:
        point = rng.permutation(np.flatnonzero(inside))[:SAMPLE]
        return point, np.zeros(len(point), dtype=np.int64)
    corner = pixels[mesh.triangles]
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    large = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > LEAST_AREA
    chosen = rng.permutation(np.flatnonzero(large & (mesh.bounces == 1) & (mesh.mirror_face >= 0)))[:SAMPLE // 3]
    point, face = mesh.triangles[chosen].ravel(), np.repeat(chosen, 3)
    return point[inside[point]], face[inside[point]]


def bent(mirror: TriangleMesh, triangle: np.ndarray, incoming: np.ndarray, ray: np.ndarray) -> np.ndarray:
    """Where Cycles bends the normal, since the ray would enter the flat triangle, or nearly would."""
    flat = mirror.face_normals()[triangle]
    facing = -(flat * incoming).sum(axis=1) / np.linalg.norm(incoming, axis=1)
    return (flat * ray).sum(axis=1) * np.sign(facing) < np.minimum(0.95 * np.abs(facing), 0.02)


CHECKS = (on_source, on_mirror, on_rays)
