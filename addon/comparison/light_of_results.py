"""The light that meshes of caustics bring, and what rays traced one by one bring to the same places, in watts."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import product

import bpy
import numpy as np

from ...core import TriangleMesh, breathe, in_steps
from ...core.rivals.tracing import Landed, LightRays, by_boxes
from ..faults import Steps, part
from ..illumination import Eye, MirrorColours, eyes_of, receiving
from ..metrics import Squares, added, light_errors, light_in_squares
from ..reading import DiffuseScene, read_mirror, read_scene

THROWS = 4  # least number of ray casts, whose differences show their noise
RAYS_AT_ONCE = 2_000_000


@dataclass(frozen=True)
class Lit:
    """The faces of one result, in world space.

    Attributes
    ----------
    positions : (n, 3) float64
    triangles : (m, 3) int64
    irradiance : (m, 3) float64
        At the corners, in W/m2.
    parity : (n,) int64
    source_object, source_face : (m,) int64
    bounces : int
        The most mirrors that light has met.
    """

    positions: np.ndarray
    triangles: np.ndarray
    irradiance: np.ndarray
    parity: np.ndarray
    source_object: np.ndarray
    source_face: np.ndarray
    bounces: int

    @classmethod
    def of(cls, result: bpy.types.Object) -> Lit | None:
        """Read the faces of a result. Return None if edits of the mesh have removed its attributes."""
        mesh = result.data
        kinds = {"irradiance": ("FLOAT", "CORNER"), "image_parity": ("INT", "POINT"), "source_object": ("INT", "FACE"),
                 "source_face": ("INT", "FACE"), "bounces": ("INT", "FACE")}
        values = {}
        for name, kind in kinds.items():
            found = mesh.attributes.get(name)
            if found is None or (found.data_type, found.domain) != kind:
                return None
            values[name] = np.empty(len(found.data), dtype=np.float32 if kind[0] == "FLOAT" else np.int32)
            found.data.foreach_get("value", values[name])
        corners, places = np.empty(len(mesh.loops), dtype=np.int32), np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.loops.foreach_get("vertex_index", corners)
        mesh.vertices.foreach_get("co", places)
        if len(corners) != 3 * len(mesh.polygons) or not len(corners):
            return None
        matrix = np.array(result.matrix_world, dtype=np.float64)
        positions = places.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
        irradiance = values["irradiance"].astype(np.float64).reshape(-1, 3)
        return cls(positions, corners.reshape(-1, 3).astype(np.int64), irradiance, values["image_parity"],
                   values["source_object"], values["source_face"], int(values["bounces"].max()))


@dataclass(frozen=True)
class Surroundings:
    """The surroundings that the light of one result meets, in world space.

    Attributes
    ----------
    surfaces : list of core.TriangleMesh
        The mirrors, that of the result first.
    colours : MirrorColours
        Colours of all triangles of the surfaces, one after another.
    scene : DiffuseScene
        Receivers.
    blockers : core.TriangleMesh or None
        Occluders.
    """

    surfaces: list
    colours: MirrorColours
    scene: DiffuseScene
    blockers: TriangleMesh | None

    @classmethod
    def of(cls, depsgraph: bpy.types.Depsgraph, mirrors: list, sources: list,
           blockers: TriangleMesh | None) -> Surroundings:
        surfaces = [read_mirror(depsgraph, mirror) for mirror in mirrors]
        return cls([surface.mesh for surface in surfaces], MirrorColours.of(surfaces),
                   read_scene(depsgraph, sources, unmirrored=True), blockers)

    def rays(self, ends: TriangleMesh, tracer: Callable = by_boxes, body: TriangleMesh | None = None) -> LightRays:
        """Return the rays of one point on the lamp, which end on a mesh. A mesh lamp may occlude them with its `body`.
        """
        others, blockers = (TriangleMesh.joined([mesh for mesh in meshes if mesh is not None])
                            for meshes in (self.surfaces[1:], (self.blockers, body)))
        return LightRays(self.surfaces[0], ends, others if len(others.triangles) else None,
                         blockers if len(blockers.triangles) else None, tracer)

    def watts(self, eye: Eye, landed: Landed) -> np.ndarray:
        """Return the power of each ray (n,) of one point on the lamp in watts, as the mean of its colours."""
        left = self.colours.left(np.stack(landed.met, axis=1), np.stack(landed.cosine, axis=1))
        return (eye.power * (landed.flux * eye.share(landed.start))[:, None] * left).mean(axis=1)

    def on_surfaces(self, lit: Lit) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners (m, 3, 3) of faces projected back to their receivers, and the receivers' normals (m, 3).
        Receivers that have moved since get an upward normal.
        """
        scene = self.scene
        key, asked = (one.astype(np.int64) * (1 << 32) + face for one, face in (
            (scene.source_object, scene.source_face), (lit.source_object, lit.source_face)))
        order = np.argsort(key)
        breathe()
        place = order[np.minimum(np.searchsorted(key[order], asked), len(key) - 1)]
        known = (key[place] == asked)[:, None]
        normal = np.where(known, scene.mesh.face_normals()[place], (0.0, 0.0, 1.0))
        corners = lit.positions[lit.triangles]
        breathe()
        start = np.where(known, scene.mesh.positions[scene.mesh.triangles[place, 0]], corners[:, 0])
        height = np.einsum("nkc,nc->nk", corners - start[:, None], normal)
        return corners - height[:, :, None] * normal[:, None], normal


def against_rays(depsgraph: bpy.types.Depsgraph, result: bpy.types.Object, lit: Lit, around: Surroundings,
                 count: int, tracer: Callable = by_boxes) -> Steps[dict]:
    """Return `light_errors` of one result, compared with about `count` rays traced by `tracer` (see `LightRays`);
    yields (fraction, "").
    """
    squares, light = yield from part(in_steps(partial(_in_squares, lit, around)), 0.0, 0.0)
    surface = around.surfaces[0]
    eyes = eyes_of(depsgraph, result.reflection_mesh.lamp, places_of(result),
                   surface.positions[surface.triangles].reshape(-1, 3))
    bodies = [eye.body for eye in eyes] if any(eye.body for eye in eyes) else [None]
    receivers = receiving(around.scene, surface)
    rays = yield from part(in_steps(lambda: [[around.rays(ends.mesh, tracer, body) for ends in receivers]
                                             for body in bodies]), 0.0, 0.0)
    normals, throws = around.scene.mesh.face_normals(), max(THROWS, -(-count // RAYS_AT_ONCE))
    each = max(count // (throws * len(eyes) * len(receivers)), 1)

    def throw(number: int) -> tuple[np.ndarray, np.ndarray]:
        names, flux = [], []
        for index, (eye, place) in enumerate(product(eyes, range(len(receivers)))):
            breathe()
            seed = number * len(eyes) * len(receivers) + index
            landed = rays[index // len(receivers) % len(rays)][place].thrown(eye.lamp, each, seed, lit.bounces)
            breathe()
            ends = receivers[place]
            names.append(squares.names(landed.points, normals[ends.kept[landed.source_face]]))
            breathe()
            flux.append(around.watts(eye, landed) * ends.share[landed.source_face])
        return added(np.concatenate(names), np.concatenate(flux))
    thrown = []
    for number in range(throws):
        thrown.append((yield from part(in_steps(partial(throw, number)), number / throws, 1.0 / throws)))
    return (yield from part(in_steps(partial(light_errors, light, thrown)), 1.0, 0.0))


def _in_squares(lit: Lit, around: Surroundings) -> tuple[Squares, tuple]:
    """Return squares around the faces of a result, and the light of the faces in them."""
    corners, facing = around.on_surfaces(lit)
    squares = Squares(corners.min(axis=(0, 1)), corners.max(axis=(0, 1)))
    return squares, light_in_squares(corners, lit.irradiance, facing, squares)


def places_of(result: bpy.types.Object) -> int:
    """Return the number of points on the lamp of a result's light."""
    return max(result.reflection_mesh.eyes, 1)
