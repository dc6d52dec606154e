"""Everything that is written into a mesh, as arrays in Blender's own types; here for a reflection with faces."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ....core import ReflectionMesh, TriangleMesh, View, breathe
from ... import compat
from ...reading.meshes import DiffuseScene, MirrorSurface
from .attribute import Attribute
from .later_mirrors import later_mirrors
from .mesh_edges import Edges
from .shown_attributes import shown_attributes
from .single_precision import in_single_precision

# limit of a Blender mesh
MOST_UV_MAPS = 8
UP = np.array((0.0, 0.0, 1.0))  # normal of faces that have none


@dataclass(frozen=True)
class Lines:
    """Edges (e,) that are sharp, edges (e,) marked for Freestyle, and faces (m,) marked for Freestyle; all bool."""

    sharp_edges: np.ndarray
    marked_edges: np.ndarray
    marked_faces: np.ndarray


@dataclass(frozen=True)
class MeshArrays:
    """Everything that `write_mesh` writes, so that writing cannot fail half way.

    Attributes
    ----------
    origin : (3,) float64
        World position of the object's origin.
    positions : (n, 3) float32
        Relative to the origin: float32 is precise only near it.
    triangles : (m, 3) int32
        No rows where the points are loose.
    attributes : tuple of Attribute
        UV maps and colours among them, the active ones first.
    materials : list of bpy.types.Material or None
    lines : Lines or None
        None of loose points.
    edges : Edges or None
        Of the triangles; None where writing is to find them.
    later_materials : list of bpy.types.Material or None
        Of the mirrors that faces are seen by after the first one, as an attribute numbers them.
    """

    origin: np.ndarray
    positions: np.ndarray
    triangles: np.ndarray
    attributes: tuple[Attribute, ...]
    materials: list
    lines: Lines | None = None
    edges: Edges | None = None
    later_materials: list = field(default_factory=list)

    def seen_in(self, materials: list) -> MeshArrays:
        """Return these arrays with only the attributes that `materials` read."""
        return replace(self, attributes=shown_attributes(self.attributes, materials))

    @property
    def uv_maps(self) -> list[str]:
        """Names of the UV maps. Loose points have UV maps as well."""
        return [attribute.name for attribute in self.attributes if attribute.kind == "FLOAT2"]


def mesh_arrays(result: ReflectionMesh, scene: DiffuseScene, surface: MirrorSurface, view: View,
                mirrors: Sequence[MirrorSurface] = ()) -> MeshArrays:
    """Return the arrays of a result with faces.

    Parameters
    ----------
    scene : DiffuseScene
        The reflected scene.
    surface : MirrorSurface
        The mirror.
    view : View
        The view for which the result was made.
    mirrors : sequence of MirrorSurface
        All mirrors that may follow the first one, in the order of the result's indices; empty for a depth of one.
    """
    result, origin = vertices_written(result, surface.mesh, view)
    breathe()
    source, mirror_face = result.source_face, result.mirror_face
    spans = mirror_face < 0
    weights = result.source_weights.astype(np.float32)
    later, later_materials = later_mirrors(result, mirrors, view)
    own = (
        Attribute("material_index", "INT", "FACE", scene.material[source].astype(np.int32)),
        *point_attributes(result),
        Attribute("source_object", "INT", "FACE", scene.source_object[source].astype(np.int32)),
        Attribute("source_face", "INT", "FACE", scene.source_face[source].astype(np.int32)),
        Attribute("bounces", "INT", "FACE", result.bounces.astype(np.int32)),
        Attribute("mirror_face", "INT", "FACE",
                  np.where(spans, -1, surface.triangle[np.where(spans, 0, mirror_face)]).astype(np.int32)),
        Attribute("sharp_face", "BOOLEAN", "FACE", scene.sharp_face[source]),
        *_normals(result, scene),
        *later,
    )
    breathe()
    # corners of the result's faces are interpolated in their source triangles
    shown = shown_layers(scene, own, "CORNER", lambda values: np.matmul(weights, values[source]))
    breathe()
    edges = Edges.of(result.triangles)
    return MeshArrays(origin, (result.positions - origin).astype(np.float32), result.triangles.astype(np.int32),
                      own + shown, scene.materials, _lines(result, scene, edges), edges, later_materials)


def vertices_written(result: ReflectionMesh, mirror: TriangleMesh, view: View) -> tuple[ReflectionMesh, np.ndarray]:
    """Round a result with faces as `mesh_arrays` writes it. Return the result and its origin (3,) in world space."""
    origin = origin_of(mirror)
    return in_single_precision(result, origin, view), origin


def _normals(result: ReflectionMesh, scene: DiffuseScene) -> tuple[Attribute, ...]:
    """Return the shading normals of the sources, reflected by the mirrors."""
    normals = result.image_normals(scene.normals)
    normals[(normals[..., 0] == 0.0) & (normals[..., 1] == 0.0) & (normals[..., 2] == 0.0)] = UP
    return (Attribute(compat.normals_attribute(), "FLOAT_VECTOR", "CORNER", normals.astype(np.float32)),)


def _lines(result: ReflectionMesh, scene: DiffuseScene, edges: Edges) -> Lines:
    """Return the edges and faces that are images of lines. Freestyle needs two more kinds of marked edges. It does not
    know sharp edges and finds no crease between faces on the mirror, so sharp edges are marked. It takes gaps for
    borders, so the borders of the surface are marked too.
    """
    side = result.source_sides
    on_side = side >= 0
    # all sides of each face's source at once
    shown = np.nonzero(on_side)[0], side[on_side]
    sharp, marked = np.zeros(side.shape, dtype=bool), np.zeros(side.shape, dtype=bool)
    sharp[on_side] = scene.sharp_side[result.source_face][shown]
    breathe()
    marked[on_side] = scene.marked_side[result.source_face][shown]
    breathe()
    sharp_edges = edges.among(sharp.reshape(-1))
    marked_edges = (sharp_edges | edges.among(marked.reshape(-1))
                    | edges.among(on_side.reshape(-1)) & edges.borders)
    return Lines(sharp_edges, marked_edges, scene.marked_face[result.source_face])


def origin_of(mirror: TriangleMesh) -> np.ndarray:
    """Return the middle of the mirror's box, rounded to single precision like an object's location."""
    corners = mirror.positions[mirror.triangles].reshape(-1, 3)
    return (0.5 * (corners.min(axis=0) + corners.max(axis=0))).astype(np.float32).astype(np.float64)


def point_attributes(result: ReflectionMesh) -> tuple[Attribute, ...]:
    """Return the point attributes that all results have."""
    return (Attribute("reflected_position", "FLOAT_VECTOR", "POINT", result.reflected_position.astype(np.float32)),
            Attribute("mirror_position", "FLOAT_VECTOR", "POINT", result.mirror_position.astype(np.float32)),
            Attribute("path_length", "FLOAT", "POINT", result.path_length.astype(np.float32)),
            Attribute("image_parity", "INT", "POINT", result.image_parity.astype(np.int32)))


def shown_layers(scene: DiffuseScene, own: tuple[Attribute, ...], domain: str,
                 at: Callable[[np.ndarray], np.ndarray]) -> tuple[Attribute, ...]:
    """Return the UV maps, colours and other attributes of the sources, without names that the result uses itself.

    Parameters
    ----------
    at : callable
        From values (m, 3, c) at the corners of the scene's triangles to those of the result.
    """
    taken = {attribute.name for attribute in own}
    # put the active layers first, so that Blender's limit does not cut them off
    uv_maps = [entry for entry in in_order(scene.uv_maps, scene.active_uv) if entry[0] not in taken][:MOST_UV_MAPS]
    taken.update(name for name, _ in uv_maps)
    colours = [entry for entry in in_order(scene.colours, scene.active_colour) if entry[0] not in taken]
    taken.update(name for name, _ in colours)
    numbers = [entry for entry in scene.numbers.items() if entry[0] not in taken]
    return (*(Attribute(name, "FLOAT2", domain, at(values)) for name, values in uv_maps),
            *(Attribute(name, kind, domain, at(values)) for name, (kind, values) in colours + numbers))


def in_order(entries: dict, name: str) -> list:
    """Return the entries as pairs, with the entry called `name` first."""
    return sorted(entries.items(), key=lambda entry: entry[0] != name)
