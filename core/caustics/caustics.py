"""The way through the house, from a lamp: the reflection that it sees, turned into light on what it shows."""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ..cameras import ReflectionMap
from ..geometry import TriangleMesh, has_area
from ..recentring import far_corner, moved_surface
from ..reflection import reflect
from ..result import ReflectionMesh
from ..support import NothingInView, ReflectionError, Settings, in_steps, tell
from .caustic_mesh import CausticMesh
from .corners import light_at
from .energy import amounting, balanced, flux_of, on_faces, shown_area
from .hiding import screens_of, shades_of
from .lamps import Lamp
from .refinement import LitFaces, refined

DETAIL = 1024
"""Pixels across the mirror in the lamp's picture, in which the settings' tolerance is counted."""
ON_CAUSTIC = 1e-5  # growth of a bundle below which bisection has put a vertex on the caustic
LEAST = 1.5e-5  # of the flux: what carries less is not split
STRAY = 1e-6  # of the flux: with less, faces with a corner to which no light comes are rounding
FINEST = 2e-3  # of the size of what is lit: shorter sides are not split


def caustics(lamp: Lamp, mirror: TriangleMesh, receivers: TriangleMesh, settings: Settings = Settings(),
             mirrors: TriangleMesh | None = None, blockers: TriangleMesh | None = None) -> CausticMesh:
    """The light of a lamp that a mirror throws on receivers.

    Parameters
    ----------
    lamp : Lamp
    mirror : TriangleMesh
        In world space, with shading normals. Two-sided.
    receivers : TriangleMesh
        In world space; they hide each other, exactly, and cast shadows on the mirror.
    settings : Settings
        The tolerance, in pixels of a picture 1024 wide of the mirror from the lamp; the depth; bounds. Other settings
        say nothing here.
    mirrors : TriangleMesh, optional
        Other mirrors: they hide, shade, and from a depth of two on throw the light on.
    blockers : TriangleMesh, optional
        What else hides and shades, without being lit.

    Returns
    -------
    CausticMesh

    Raises
    ------
    ReflectionError
        Where the mirror or the receivers are empty, the lamp lies on the mirror, or does not see it.

    Examples
    --------
    >>> import numpy as np
    >>> from core import Lamp, TriangleMesh, caustics
    >>> mirror = TriangleMesh(np.array([[0, -1, 1], [0, 1, 1], [0, 0, 2.0]]), np.array([[0, 1, 2]]))
    >>> floor = TriangleMesh(np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]]))
    >>> mesh = caustics(Lamp((1, 0, 3)), mirror, floor)
    >>> at = mesh.positions[mesh.triangles].mean(axis=1)
    >>> way = at - (-1, 0, 3)  # as from the lamp behind the mirror
    >>> length = np.linalg.norm(way, axis=1)
    >>> np.allclose(mesh.irradiance.mean(axis=1), 3 / length**3, rtol=0.05)
    True
    """
    _check(lamp, receivers, blockers)
    corner = far_corner(mirror) if isinstance(mirror, TriangleMesh) and len(mirror.triangles) else None
    if corner is None:
        return _near_origin(lamp, mirror, receivers, settings, mirrors, blockers)
    others = [None if mesh is None else moved_surface(mesh, -corner) for mesh in (mirrors, blockers)]
    mesh = _near_origin(lamp.moved(-corner), moved_surface(mirror, -corner), moved_surface(receivers, -corner),
                        settings, *others)
    return replace(mesh, positions=mesh.positions + corner, mirror_position=mesh.mirror_position + corner)


def caustic_steps(lamp: Lamp, mirror: TriangleMesh, receivers: TriangleMesh, settings: Settings = Settings(),
                  mirrors: TriangleMesh | None = None, blockers: TriangleMesh | None = None
                  ) -> Generator[tuple[float, str], None, CausticMesh]:
    """`caustics` in steps, as `reflection_steps` yields them.

    Examples
    --------
    >>> import numpy as np
    >>> from core import Lamp, TriangleMesh, caustic_steps
    >>> mirror = TriangleMesh(np.array([[0, -1, 1], [0, 1, 1], [0, 0, 2.0]]), np.array([[0, 1, 2]]))
    >>> floor = TriangleMesh(np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]]))
    >>> next(caustic_steps(Lamp((1, 0, 3)), mirror, floor))  # in a generator: mesh = yield from caustic_steps(...)
    (0.0, 'k-d tree')
    """
    return (yield from in_steps(lambda: caustics(lamp, mirror, receivers, settings, mirrors, blockers)))


def _near_origin(lamp: Lamp, mirror: TriangleMesh, receivers: TriangleMesh, settings: Settings,
                 mirrors: TriangleMesh | None, blockers: TriangleMesh | None) -> CausticMesh:
    body, scene, standing = (TriangleMesh.joined([mesh for mesh in meshes if mesh is not None]) for meshes in (
        (mirror, mirrors), (receivers, blockers), (receivers, blockers, mirrors)))
    screens, shades = screens_of(body, receivers, scene), shades_of(lamp, mirror, standing)
    settings = replace(settings, hidden_faces=True, method="GENERAL", placement="SURFACE")
    parts = []
    for view in lamp.views(mirror, shades, screens, DETAIL):
        try:
            seen = reflect(view, mirror, receivers, settings, body)
        except NothingInView:
            continue
        tell(0.9, "irradiance")
        if len(seen.triangles):
            parts.append(_light(lamp, seen, receivers, settings))
    return _joined(parts)


def _light(lamp: Lamp, seen: ReflectionMesh, receivers: TriangleMesh, settings: Settings) -> list[tuple]:
    """The light of one view's faces, of each bounce for itself."""
    lit = []
    view = seen.maps[0].view
    whole = flux_of(view, seen.mirror_position[seen.triangles]).sum()
    reach = np.ptp(seen.reflected_position, axis=0).max()
    for number, ray_map in enumerate(seen.maps, 1):
        chosen = np.flatnonzero(seen.bounces == number)
        if not len(chosen):
            continue
        faces = _faces(ray_map, seen, chosen, receivers)
        faces = refined(ray_map, faces, receivers, (LEAST * whole, FINEST * reach), settings.maximum_faces)
        places = np.moveaxis(faces.light.place.reshape(3, 3, -1), 2, 0).swapaxes(1, 2)
        lit.append((faces, flux_of(view, places), seen, number, receivers))
    return lit


def _faces(ray_map: ReflectionMap, seen: ReflectionMesh, chosen: np.ndarray, receivers: TriangleMesh) -> LitFaces:
    assert seen.map_face is not None  # a lamp's view tells it
    triangles, face = seen.triangles[chosen], seen.map_face[chosen]
    corner, owner = triangles.T.ravel(), np.tile(face, 3)
    source = seen.source_face[chosen]
    normal = receivers.face_normals()[source].T
    points = seen.reflected_position.T
    uv = ray_map.coordinates(owner, seen.mirror_position[corner].T)
    light = light_at(ray_map, owner, uv, points[:, corner], np.tile(normal, 3))
    return LitFaces(triangles, points, face, normal, source, chosen, seen.source_sides[chosen] >= 0,
                    np.full((len(chosen), 3), np.nan), light)


def _joined(parts: list) -> CausticMesh:
    reach = _reach([entry[0] for part in parts for entry in part])
    found = [arrays for arrays in (_arrays(entry, reach) for part in parts for entry in part)
             if len(arrays["triangles"])]
    if not found:
        raise NothingInView("The mirror throws none of the lamp's light on the objects; move the lamp, the mirror or "
                            "the objects.")
    counts: dict = {}
    for part in parts:
        for name, count in part[0][2].counts.items() if part else ():
            counts[name] = counts.get(name, 0) + count
    start = np.cumsum([0] + [len(entry["positions"]) for entry in found])
    for entry, first in zip(found, start):
        entry["triangles"] = entry["triangles"] + first
    mesh = CausticMesh(**{name: np.concatenate([entry[name] for entry in found]) for name in found[0]}, counts=counts)
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return replace(mesh, irradiance=amounting(mesh.irradiance, mesh.flux, area))


def _reach(parts: list[LitFaces]) -> float:
    """How far the faces of all views and bounces reach."""
    points = np.concatenate([np.zeros((3, 0)), *(faces.points[:, faces.triangles.ravel()] for faces in parts)], axis=1)
    return float(np.ptp(points, axis=1).max()) if points.size else 0.0


def _arrays(lit: tuple[LitFaces, np.ndarray, ReflectionMesh, int, TriangleMesh], reach: float) -> dict:
    """What `CausticMesh` holds of one view's light of one bounce, as `_light` tells it."""
    faces, flux, seen, number, receivers = lit
    light, corners = faces.light, np.moveaxis(faces.corners, 2, 0).swapaxes(1, 2)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area, size = 0.5 * np.linalg.norm(normal, axis=1), np.abs(corners - corners[:, :1]).max(axis=(1, 2))
    arrived = light.arrived.reshape(3, -1).all(axis=0) | (flux > STRAY * flux.sum())
    kept = np.flatnonzero(has_area(area, size) & (flux > 0.0) & arrived)
    irradiance, cosine, side = (value.reshape(3, -1).T[kept] for value in (
        light.irradiance, light.cosine, light.side))
    irradiance = balanced(irradiance, on_faces(flux[kept], faces.beside[kept], faces.triangles[kept]),
                          faces.triangles[kept], shown_area(corners[kept], area[kept], reach))
    # turned to the side that is lit
    over = (side.sum(axis=1) < 0.0) != ((normal[kept] * faces.normal[:, kept].T).sum(axis=1) < 0.0)
    order = np.where(over[:, None], (0, 2, 1), (0, 1, 2))
    triangles, irradiance, cosine = (np.take_along_axis(values, order, axis=1) for values in (
        faces.triangles[kept], irradiance, cosine))
    corners = np.take_along_axis(corners[kept], order[:, :, None], axis=1)
    source = faces.source[kept]
    used, first = np.unique(faces.triangles[kept], return_index=True)
    number_of = np.zeros(faces.points.shape[1], dtype=np.int64)
    number_of[used] = np.arange(len(used))
    entry = (first % 3) * len(faces) + kept[first // 3]
    parity = np.where(np.abs(light.turned[entry]) < ON_CAUSTIC, 0, np.sign(light.turned[entry]))
    return {
        "positions": faces.points[:, used].T, "triangles": number_of[triangles], "irradiance": irradiance,
        "flux": flux[kept], "mirror_position": light.place[:, entry].T,
        "image_parity": parity.astype(np.int8), "cosine": cosine, "source_face": source,
        "source_weights": _weights(receivers, source, corners),
        "bounces": np.full(len(kept), number, dtype=np.int8)}


def _weights(receivers: TriangleMesh, source: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (m, 3, 3) of corners in their source triangles, none negative."""
    a, b, c = np.moveaxis(receivers.positions[receivers.triangles[source]], 1, 0)[:, :, None]
    normal = np.cross(b - a, c - a)
    squared = np.maximum((normal**2).sum(axis=2), 1e-300)
    second = (np.cross(corners - a, c - a) * normal).sum(axis=2) / squared
    third = (np.cross(b - a, corners - a) * normal).sum(axis=2) / squared
    weights = np.maximum(np.stack((1.0 - second - third, second, third), axis=2), 0.0)
    weights /= weights.sum(axis=2, keepdims=True)
    # beside a sliver that tells little of where along it a corner lies
    places = receivers.positions[receivers.triangles[source]]
    for first, second in ((0, 1), (1, 2), (2, 0)):
        along = (places[:, second] - places[:, first])[:, None]
        astray = ((corners - np.matmul(weights, places)) * along).sum(axis=2)
        moved = astray / np.maximum((along**2).sum(axis=2), 1e-300)
        moved = np.clip(moved, -weights[:, :, second], weights[:, :, first])
        weights[:, :, first] -= moved
        weights[:, :, second] += moved
    return weights


def _check(lamp: Lamp, receivers: TriangleMesh, blockers: TriangleMesh | None) -> None:
    for given, kinds, wrong in (
            (lamp, Lamp, "The lamp must be a Lamp; make one of its position, or of a sun's direction with shining."),
            (receivers, TriangleMesh, "The receivers must be a TriangleMesh; make one of their positions and "
             "triangles."),
            (blockers, (TriangleMesh, type(None)), "The blockers must be one TriangleMesh; join them or leave them "
             "out.")):
        if not isinstance(given, kinds):
            raise ReflectionError(wrong)
