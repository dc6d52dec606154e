"""Assembly: nodes and faces of all bounces as the plain arrays of the result."""
from __future__ import annotations

import numpy as np

from .bounce import Bounce
from .met_surfaces import MetSurfaces
from .placement import place
from .reflection_mesh import ReflectionMesh
from .vectors import groups, norm, rows
from .view import View

ON_CAUSTIC = 1e-5  # magnification below which bisection has put a node on the caustic


def assemble(view: View, bounces: list[Bounce], met: MetSurfaces, placement: str) -> ReflectionMesh:
    """The faces as arrays, no two on the same nodes, without unused nodes, all turned to the eye."""
    parts, start = [], 0
    for number, bounce in enumerate(bounces, 1):
        part = _arrays(view, bounce, met)
        part["bounces"] = np.full(len(part["triangles"]), number, dtype=np.int8)
        part["triangles"] = part["triangles"] + start
        start += len(part["path_length"])
        parts.append(part)
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    whole["positions"] = place(view, whole["mirror_position"].T, whole["path_length"], placement).T
    return ReflectionMesh(**whole)


def _arrays(view: View, bounce: Bounce, met: MetSurfaces) -> dict:
    mirror_map, frames, nodes, faces = bounce.mirror_map, bounce.frames, bounce.nodes, bounce.faces
    # mirrors are seen by what they show
    faces = faces.select(~met.shows_mirror(frames)[faces.column])
    # doubled triangles of the scene, and polygons that fold flat, give the same face twice
    once, _ = groups(*np.sort(faces.nodes, axis=1).T)
    faces = faces.select(np.sort(once))
    used, corner = np.unique(faces.nodes, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    seen, point = nodes.place[:, used], nodes.point[:, used].copy()
    pixels = view.pixels(seen.T)[triangles]
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    away = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0.0
    triangles[away] = triangles[away][:, [0, 2, 1]]
    column = np.repeat(faces.column, 3)
    weights = frames.weights(column, np.take(point, triangles.ravel(), axis=1))
    # straight outlines may leave a corner a fraction of a pixel beside its triangle: it takes the point of the rim
    beside = np.flatnonzero(weights.min(axis=0) < 0.0)
    weights = np.maximum(weights, 0.0)
    weights /= weights.sum(axis=0)
    rim = rows(met.positions[frames.vertices[:, column[beside]]])
    point[:, triangles.ravel()[beside]] = (rim * weights[:, beside]).sum(axis=1)

    face = bounce.cameras.face[faces.camera]
    owner = np.zeros(len(used), dtype=np.int64)
    owner[triangles.ravel()] = np.repeat(face, 3)
    uv = mirror_map.coordinates(owner, seen)
    turned = mirror_map.turned(owner, uv, nodes.distance[used])
    ways = mirror_map.ways(owner, uv)
    path = norm(point - seen) if not ways else ways[-1] + norm(point - mirror_map.leave(owner, uv)[0])
    return {
        "triangles": triangles, "reflected_position": point.T, "mirror_position": seen.T, "path_length": path,
        "image_parity": np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned)).astype(np.int8),
        "source_face": frames.triangle[faces.column],
        "source_weights": weights.T.reshape(-1, 3, 3), "mirror_face": mirror_map.first(face)}
