"""Light on receivers as a mesh that lies just before them."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import CausticMesh, breathe
from ...core.geometry import areas
from ..reading import DiffuseScene
from ..writing import Attribute, Edges, MeshArrays, shown_layers
from .caustic_material import LIGHT, UNSEEN
from .light_sources import Eye
from .mirrors import MirrorPart, Tint, mirror_attributes
from .receiver_places import PLACES, places_asked

LIFT = 1e-4  # offset of the mesh, relative to the size of the lit object or of the camera's picture there
ROUNDING = 2.0 ** -20  # relative to a coordinate; a multiple of the rounding of single precision
DEPTH_STEP = 2.0 ** -22  # relative to the depth; a multiple of the resolution of the viewport's depth buffer
SPREAD = 2.0  # factor between the offsets of the last layer and the first
ACROSS = np.array((0.6180, 0.7071, 0.3437))  # direction along which few points of a mirror have equal coordinates
FLAT = 1e-11  # tolerance of the scalar product of equal unit vectors
GRAZING = 1e-2  # smallest cosine of the angle of incidence that is used for shading
MOST_LIFT = 2e-3  # largest offset, relative to the size of the lit object


@dataclass(frozen=True)
class MirrorPlaces:
    """The tints of a mirror that are textured, and the mirror with its coordinates (None if there are none)."""

    tints: list[Tint]
    mirror: DiffuseScene | None


def caustic_arrays(lit: list[tuple[Eye, MirrorPart, CausticMesh]], scene: DiffuseScene,
                   places: MirrorPlaces, camera: bpy.types.Object | None) -> MeshArrays:
    """Return the arrays of one object with the caustics of all points on a lamp and of all parts of a mirror.

    Its faces are transparent and add their own light, so they may overlap in any order.
    """
    meshes = [mesh for *_, mesh in lit]
    positions = np.concatenate([mesh.positions for mesh in meshes])
    start = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
    triangles = np.concatenate([mesh.triangles + first for mesh, first in zip(meshes, start)])
    together = {name: np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in (
        "mirror_position", "image_parity", "source_face", "source_weights", "direction", "bounces")}
    breathe()
    parts = [(part, mesh.irradiance[:, :, None] * eye.power, mesh) for eye, part, mesh in lit]
    light = np.concatenate([sent * part.colours.left(mesh.met, mesh.cosine) for part, sent, mesh in parts])
    breathe()
    irradiance, share = light.mean(axis=2), _shading(scene, together)
    low, high = positions.min(axis=0), positions.max(axis=0)
    origin = (0.5 * (low + high)).astype(np.float32).astype(np.float64)
    size = float((high - low).max())
    breathe()
    place = np.repeat(np.arange(len(meshes)), [len(mesh.positions) for mesh in meshes])
    lift = _lift(positions, size, float(np.abs(positions).max()), camera)
    lift *= _layers(together["mirror_position"], together["image_parity"], place)
    flat, positions = areas(positions[triangles]), positions + lift[:, None] * _normals(positions, triangles)
    # slivers stand upright between the layers that meet on a caustic, and have many times their flat area
    share *= (flat / np.maximum(areas(positions[triangles]), np.maximum(flat, 1e-300)))[:, None]
    light *= share[:, :, None]
    breathe()
    source, weights = together["source_face"], together["source_weights"].astype(np.float32)
    own = (
        Attribute("material_index", "INT", "FACE", scene.material[source].astype(np.int32)),
        Attribute("irradiance", "FLOAT", "CORNER", irradiance.astype(np.float32)),
        Attribute(LIGHT, "FLOAT_VECTOR", "CORNER", light.astype(np.float32)),
        Attribute("mirror_position", "FLOAT_VECTOR", "POINT", together["mirror_position"].astype(np.float32)),
        Attribute("image_parity", "INT", "POINT", together["image_parity"].astype(np.int32)),
        Attribute("source_object", "INT", "FACE", scene.source_object[source].astype(np.int32)),
        Attribute("source_face", "INT", "FACE", scene.source_face[source].astype(np.int32)),
        Attribute("bounces", "INT", "FACE", together["bounces"].astype(np.int32)))
    breathe()
    known = {"Generated": scene.generated, "Object": scene.own_places}
    own += tuple(Attribute(PLACES[name], "FLOAT_VECTOR", "CORNER", np.matmul(weights, known[name][source]))
                 for name in places_asked(scene.materials))
    own += _unseen(scene, source) + mirror_attributes(_by_later_mirrors(parts, share), places.tints, places.mirror)
    shown = shown_layers(scene, own, "CORNER", lambda values: np.matmul(weights, values[source]))
    breathe()
    return MeshArrays(origin, (positions - origin).astype(np.float32), triangles.astype(np.int32), own + shown,
                      scene.materials, edges=Edges.of(triangles))


def _unseen(scene: DiffuseScene, source: np.ndarray) -> tuple[Attribute, ...]:
    """Return an attribute (m,) that marks faces on objects hidden from the camera, for lit triangles `source` (m,).
    Return nothing if all objects are visible.
    """
    seen = np.array([obj.visible_camera for obj in scene.sources])
    return () if seen.all() else (
        Attribute(UNSEEN, "FLOAT", "FACE", (~seen[scene.source_object[source]]).astype(np.float32)),)


def _by_later_mirrors(parts: list[tuple[MirrorPart, np.ndarray, CausticMesh]],
                      share: np.ndarray) -> list[tuple[MirrorPart, np.ndarray, CausticMesh]]:
    """Return the parts of a mirror with their light (m, 3, 3) after the absorption by later mirrors, and their faces.
    `share` (m, 3) is the share of the light of each part that is shown.
    """
    start = np.cumsum([0] + [len(sent) for _, sent, _ in parts])
    return [(part, sent * part.colours.left(mesh.met[:, 1:], mesh.cosine[:, :, 1:])
             * share[first:first + len(sent), :, None], mesh) for (part, sent, mesh), first in zip(parts, start)]


def _shading(scene: DiffuseScene, together: dict) -> np.ndarray:
    """Return the factor (m, 3) by which smooth normals of the receivers change the light at the corners. Engines shade
    by the cosine to these normals instead of the flat triangle's.
    """
    used, own = np.unique(together["source_face"], return_inverse=True)
    flat = scene.mesh.face_normals()[used][:, None]
    normals = _unit(scene.normals[used], flat)
    # most receivers are flat
    smooth = np.flatnonzero(((normals * flat).sum(axis=2).min(axis=1) <= 1.0 - FLAT)[own])
    share = np.ones((len(own), 3))
    flat, direction = flat[own[smooth]], together["direction"][smooth]
    shown = _unit(np.matmul(together["source_weights"][smooth], normals[own[smooth]]), flat)
    level = (flat * direction).sum(axis=2)
    level = np.copysign(np.maximum(np.abs(level), GRAZING), level)
    bent = np.maximum((shown * direction).sum(axis=2) / level, 0.0)
    share[smooth] = np.where((shown * flat).sum(axis=2) > 1.0 - FLAT, 1.0, bent)
    return share


def _unit(vectors: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Normalise vectors (..., 3); replace vectors without length by those of `other`."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(length > 0.0, vectors / np.where(length > 0.0, length, 1.0), other)


def _lift(positions: np.ndarray, size: float, farthest: float, camera: bpy.types.Object | None) -> np.ndarray:
    """Return the offset (n,) of the mesh from its receivers. Single precision and, from the camera, the depth buffer
    must be able to separate both.
    """
    if camera is None or camera.type != "CAMERA":
        return np.full(len(positions), LIFT * size + ROUNDING * farthest)
    distance = np.linalg.norm(positions - np.array(camera.matrix_world.translation), axis=1)
    # less than a pixel: what is small on a wide floor would stand in a shell of light
    least = LIFT * np.minimum(size, _seen_width(camera.data, distance)) + ROUNDING * np.maximum(farthest, distance)
    return np.clip(DEPTH_STEP * distance**2 / camera.data.clip_start, least, np.maximum(MOST_LIFT * size, least))


def _seen_width(camera: bpy.types.Camera, distance: np.ndarray) -> np.ndarray | float:
    """Return the width (n,) of the camera's picture at a distance."""
    if camera.type == "ORTHO":
        return float(camera.ortho_scale)
    return distance if camera.type == "PANO" else 2.0 * np.tan(0.5 * camera.angle) * distance


def _layers(mirror_position: np.ndarray, parity: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the factor (n,) of the offset that separates layers: mirrored faces, light from elsewhere on the mirror,
    and other points `place` (n,) of the lamp. Cycles merges surfaces at the same position.
    """
    along = mirror_position @ ACROSS
    along = (along - along.min()) / max(float(np.ptp(along)), 1e-300)
    return 1.0 + SPREAD * (place + 0.5 * along + 0.25 * (1 - parity)) / (place.max() + 1)


def _normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return unit normals (n, 3) of vertices towards the lit side, scaled so that all adjacent faces get the same
    offset.
    """
    corners = positions[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.stack([np.bincount(triangles.ravel(), np.repeat(normal[:, axis], 3), minlength=len(positions))
                      for axis in range(3)], axis=1)
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
