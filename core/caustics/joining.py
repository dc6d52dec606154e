"""Joining of the light of all views of a lamp and all bounces into one mesh whose irradiance integrates to its flux."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import ReflectionMap
from ..geometry import SceneFrames, TriangleMesh, areas, columns, cross, distinct, dot, has_area, norm, rows, unit
from ..result import ReflectionMesh
from ..support import NothingInView, breathe
from .caustic_mesh import CausticMesh
from .energy import amounting, balanced, on_faces, shown_area
from .refinement import LitFaces
from .slivers import merged

OF_VERTICES = ("positions", "mirror_position", "image_parity")  # vertex arrays of `CausticMesh`; others belong to faces
ON_CAUSTIC = 1e-5  # growth of a bundle below which bisection has put a vertex on the caustic
STRAY = 1e-6  # share of the flux: faces with less are dropped as rounding if no ray hits one of their corners


def joined(parts: list) -> CausticMesh:
    """Join the light of all views into one mesh.

    Parameters
    ----------
    parts : list
        For each view a list of tuples (faces, flux, reflection, bounce, receivers), one for each bounce.

    Raises
    ------
    NothingInView
        If no face is lit.
    """
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
    most = max(entry["met"].shape[1] for entry in found)
    for entry, first in zip(found, start):
        entry["triangles"] = entry["triangles"] + first
        more = most - entry["met"].shape[1]
        entry["met"] = np.pad(entry["met"], ((0, 0), (0, more)), constant_values=-1)
        entry["cosine"] = np.pad(entry["cosine"], ((0, 0), (0, 0), (0, more)))
    arrays = {name: np.concatenate([entry[name] for entry in found]) for name in found[0]}
    breathe()
    vertices, triangles, faces = merged(arrays["positions"], arrays["triangles"])
    kept = {name: values[vertices if name in OF_VERTICES else faces] for name, values in arrays.items()}
    mesh = CausticMesh(**{**kept, "triangles": triangles}, counts=counts)
    breathe()
    area = areas(mesh.positions[mesh.triangles])
    return replace(mesh, irradiance=amounting(mesh.irradiance, mesh.flux, area))


def _reach(parts: list[LitFaces]) -> float:
    """Return the longest side of the bounding box of the faces of all views and bounces, in scene units."""
    points = np.concatenate([np.zeros((3, 0)), *(faces.points[:, faces.triangles.ravel()] for faces in parts)], axis=1)
    return float(np.ptp(points, axis=1).max()) if points.size else 0.0


def _arrays(lit: tuple[LitFaces, np.ndarray, ReflectionMesh, int, TriangleMesh], reach: float) -> dict:
    """Return the arrays of a `CausticMesh` for one view and one bounce, by the names of its attributes.

    Faces without an area or without flux are left out, and faces that are rounding: see `STRAY`.

    Parameters
    ----------
    lit : tuple
        (faces, flux, reflection, bounce, receivers): the m lit faces, the flux (m,) of each, the reflection in the
        lamp's view, the number of bounces from 1 on, and the mesh that receives the light.
    reach : float
        Longest side of the bounding box of all lit faces, of all views and bounces, in scene units. The rounding of
        positions in single precision is in proportion to it.
    """
    faces, flux, seen, number, receivers = lit
    light, corners = faces.light, faces.corners()
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area, size = 0.5 * norm(normal), np.abs(corners[:, 1:] - corners[:, :1]).max(axis=(0, 1))
    arrived = light.arrived.all(axis=0) | (flux > STRAY * flux.sum())
    kept = np.flatnonzero(has_area(area, size) & (flux > 0.0) & arrived)
    corners = corners.transpose(2, 1, 0)[kept]
    irradiance, side = (value.T[kept] for value in (light.irradiance, light.side))
    cosine = light.cosine.T[kept]
    irradiance = balanced(irradiance, on_faces(flux[kept], faces.beside[kept], faces.triangles[kept]),
                          faces.triangles[kept], shown_area(corners, area[kept], reach))
    breathe()
    # order the corners so that normals point to the lit side
    over = (side.sum(axis=1) < 0.0) != (dot(normal[:, kept], faces.normal[:, kept]) < 0.0)
    order = np.where(over[:, None], (0, 2, 1), (0, 1, 2))
    triangles, irradiance = (np.take_along_axis(values, order, axis=1) for values in (
        faces.triangles[kept], irradiance))
    corners, direction, cosine = (np.take_along_axis(values, order[:, :, None], axis=1) for values in (
        corners, _directions(seen.maps[number - 1], faces, kept), cosine))
    met = _met(seen, faces.origin[kept])
    source = faces.source[kept]
    weights = _weights(receivers, source, corners)
    breathe()
    used, first = np.unique(faces.triangles[kept], return_index=True)
    number_of = np.zeros(faces.points.shape[1], dtype=np.int64)
    number_of[used] = np.arange(len(used))
    face, corner = kept[first // 3], first % 3
    turned = light.turned[corner, face]
    parity = np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned))
    return {
        "positions": faces.points[:, used].T, "triangles": number_of[triangles], "irradiance": irradiance,
        "flux": flux[kept], "mirror_position": light.place[:, corner, face].T,
        "image_parity": parity.astype(np.int8), "met": met, "direction": direction,
        "cosine": np.pad(cosine, ((0, 0), (0, 0), (0, met.shape[1] - number))),
        "source_face": source, "source_weights": weights,
        "bounces": np.full(len(kept), number, dtype=np.int8)}


def _met(seen: ReflectionMesh, face: np.ndarray) -> np.ndarray:
    """Return the indices (m, b) of the mirror triangles that the light of `face` (m,) of a reflection hits."""
    assert seen.later_mirrors is not None  # reflections in a `LampView` have them
    return np.column_stack((seen.mirror_face[face], seen.later_mirrors[face]))


def _directions(ray_map: ReflectionMap, faces: LitFaces, kept: np.ndarray) -> np.ndarray:
    """Return the unit directions (m, 3, 3) of light at the corners of the faces `kept` (m,), as [face, corner, xyz]."""
    return np.stack([unit(ray_map.rays(faces.face[kept], faces.light.uv[:, corner, kept])).T for corner in range(3)],
                    axis=1)


def _weights(receivers: TriangleMesh, source: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return barycentric coordinates (m, 3, 3) of `corners` (m, 3, 3) in triangles `source` (m,), none negative."""
    ends = [columns(rows(receivers.positions), corner)[:, None] for corner in receivers.triangles[source].T]
    places, (seen, column) = corners.transpose(2, 1, 0), distinct(source)
    weights = SceneFrames.of(receivers, seen).weights_within(column, places)
    # in slivers these are inexact along the long sides: move the point along each side to the nearest place
    for one, other in ((0, 1), (1, 2), (2, 0)):
        breathe()
        along = ends[other] - ends[one]
        told = sum(weight * end for weight, end in zip(weights, ends))
        moved = dot(places - told, along) / np.maximum(dot(along, along), 1e-300)
        moved = np.clip(moved, -weights[other], weights[one])
        weights[one] -= moved
        weights[other] += moved
    return weights.transpose(2, 1, 0).copy()
