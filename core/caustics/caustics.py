"""The pipeline for caustics: the reflection that a lamp sees, turned into light on the receivers."""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import numpy as np

from ..cameras import ReflectionMap
from ..geometry import TriangleMesh
from ..given import NO_AREA
from ..recentring import far_corner, moved_surface
from ..reflection import reflect
from ..result import ReflectionMesh
from ..support import NothingInView, Settings, breathe, in_steps, must_be, portions, tell
from .caustic_mesh import CausticMesh
from .corners import Corners, light_at, mean_weight
from .energy import flux_of
from .hiding import screens_of, shades_of
from .joining import joined
from .lamps import Lamp
from .refinement import LitFaces, refined
from .slivers import Stitched, without_slivers

DETAIL = 1024
"""Pixels across the mirror in the lamp's picture, in which the settings' tolerance is counted."""
LEAST = 1.5e-5  # share of a lamp's whole flux: faces that carry less are not split
FINEST = 2e-3  # share of the lit region's size: shorter sides are not split
AT_ONCE = 1 << 14


def caustics(lamp: Lamp, mirror: TriangleMesh, receivers: TriangleMesh, settings: Settings = Settings(),
             mirrors: TriangleMesh | None = None, blockers: TriangleMesh | None = None) -> CausticMesh:
    """Compute the caustics that a mirror casts on receivers from the light of a lamp.

    Parameters
    ----------
    lamp : Lamp
    mirror : TriangleMesh
        In world space, with shading normals. Two-sided.
    receivers : TriangleMesh
        In world space. They occlude each other exactly, and cast shadows on the mirror.
    settings : Settings
        The tolerance, in pixels of a picture of the mirror from the lamp, 1024 pixels wide; the depth; the limits.
        Other settings are ignored.
    mirrors : TriangleMesh, optional
        Other mirrors. They occlude light, and from a depth of two on they reflect it.
    blockers : TriangleMesh, optional
        Other occluders, which receive no light.

    Returns
    -------
    CausticMesh

    Raises
    ------
    ReflectionError
        If the mirror or the receivers are empty, the lamp lies on the mirror, or does not see it.

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
    must_be(lamp, Lamp, "The lamp must be a Lamp; make one of its position, or of a sun's direction with shining.")
    must_be(receivers, TriangleMesh, "The receivers must be a TriangleMesh; make one of their positions and triangles.")
    must_be(blockers, (TriangleMesh, type(None)), "The blockers must be one TriangleMesh; join them or leave them out.")
    if isinstance(mirror, TriangleMesh) and len(mirror.triangles) and not mirror.face_normals().any():
        raise NothingInView(NO_AREA)
    # automatic depth means one bounce here: later bounces carry little light
    settings = replace(settings, depth=settings.depth or 1)
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
    """Run `caustics` as a generator that yields like `reflection_steps` and returns the `CausticMesh`.

    Examples
    --------
    >>> import numpy as np
    >>> from core import Lamp, TriangleMesh, caustic_steps
    >>> mirror = TriangleMesh(np.array([[0, -1, 1], [0, 1, 1], [0, 0, 2.0]]), np.array([[0, 1, 2]]))
    >>> floor = TriangleMesh(np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]]))
    >>> next(caustic_steps(Lamp((1, 0, 3)), mirror, floor))  # in a generator: mesh = yield from caustic_steps(...)
    (0.0, 'Preparing the scene')
    """
    return (yield from in_steps(lambda: caustics(lamp, mirror, receivers, settings, mirrors, blockers)))


def _near_origin(lamp: Lamp, mirror: TriangleMesh, receivers: TriangleMesh, settings: Settings,
                 mirrors: TriangleMesh | None, blockers: TriangleMesh | None) -> CausticMesh:
    body, scene, standing = (TriangleMesh.joined([mesh for mesh in meshes if mesh is not None]) for meshes in (
        (mirror, mirrors), (receivers, blockers), (receivers, blockers, mirrors)))
    # from two bounces on, a ray segment may also end at a mirror
    ends = receivers if settings.depth == 1 else TriangleMesh.joined((receivers, body))
    screens, shades = screens_of(body, ends, scene), shades_of(lamp, mirror, standing)
    settings = replace(settings, hidden_faces=True, method="GENERAL", placement="SURFACE")
    parts = []
    for view in lamp.views(mirror, shades, screens, DETAIL):
        try:
            seen = reflect(view, mirror, receivers, settings, body)
        except NothingInView:
            continue
        tell(0.9, "Computing brightness")
        if len(seen.triangles):
            parts.append(_light(lamp, seen, receivers, settings))
    return joined(parts)


def _light(lamp: Lamp, seen: ReflectionMesh, receivers: TriangleMesh, settings: Settings) -> list[tuple]:
    """Compute the light of one view's faces.

    `seen` is the reflection in the lamp's view. Return one tuple (faces, flux, reflection, bounce, receivers) for each
    bounce.
    """
    lit = []
    view = seen.maps[0].view
    sent = seen.mirror_position[seen.triangles]
    whole = (flux_of(view, sent) * lamp.mean_share(sent)).sum()
    reach = np.ptp(seen.reflected_position, axis=0).max()
    stitched, bounces = without_slivers(seen), np.asarray(seen.bounces)
    for number, ray_map in enumerate(seen.maps, 1):
        chosen = stitched.select(bounces[stitched.origin] == number)
        if not len(chosen):
            continue
        breathe()
        faces = _faces(ray_map, seen, chosen, receivers, lamp)
        faces, bounded = refined(ray_map, faces, receivers, lamp, (LEAST * lamp.places * whole, FINEST * reach),
                                 settings.maximum_faces)
        seen.counts["bounded"] = seen.counts.get("bounded", 0) | bounded
        places = faces.light.place.transpose(2, 1, 0)
        flux = flux_of(view, places) * mean_weight(ray_map, faces.face, faces.light, lamp)
        lit.append((faces, flux, seen, number, receivers))
    return lit


def _faces(ray_map: ReflectionMap, seen: ReflectionMesh, stitched: Stitched, receivers: TriangleMesh,
           lamp: Lamp) -> LitFaces:
    assert seen.map_face is not None  # reflections in a `LampView` have it
    triangles, face = stitched.triangles, seen.map_face[stitched.origin]
    source, points = seen.source_face[stitched.origin], seen.reflected_position.T
    normal, parts = receivers.face_normals()[source].T, []
    for own in portions(len(triangles), AT_ONCE):
        corner, owner = triangles[own].T.ravel(), np.tile(face[own], 3)
        uv = ray_map.coordinates(owner, seen.mirror_position[corner].T)
        parts.append(light_at(ray_map, owner, uv, points[:, corner], np.tile(normal[:, own], 3), lamp).of_faces())
    return LitFaces(triangles, points, face, normal, source, stitched.origin, stitched.on_side,
                    np.full((len(triangles), 3), np.nan), Corners.joined(parts))
