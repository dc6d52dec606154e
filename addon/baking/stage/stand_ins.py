"""Stand-ins for objects that are baked: the same to look at, but every triangle has room of its own in a picture."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ....core.geometry import first_of
from ... import compat
from ...faults import Steps, still_there
from ...reading.meshes import LocalMesh, Placed
from ...writing import UV_MAP, write_mesh
from ...writing.arrays import MOST_UV_MAPS, Attribute, MeshArrays, in_order
from ..texels import Division, divided
from .true_answers import RANDOM, answer_name
from .undeformed import keep_undeformed


@dataclass(frozen=True)
class StandIn:
    """One place of a mesh: whose it is, where, and what of the map is its own.

    Attributes
    ----------
    owner : int
        Index of the participant.
    mesh : LocalMesh
    matrix : (4, 4) float64
    count : (m,) int64
        Parts along a side of each of its triangles.
    uv : (p, 3, 2) float32
        Of the corners of these parts.
    turned : bool
        Whether its back is asked for: a bake shades the front.
    told : (6,) float64 or None
        What Object Info tells of it where it is an instance, as `Placed` has it; None where it is the participant
        itself.
    answers : dict
        What its materials ask of it, by question.
    undeformed : (n, 3) float32 or None
        Where the vertices of the mesh are for Generated coordinates; None: where they are.
    """

    owner: int
    mesh: LocalMesh
    matrix: np.ndarray
    count: np.ndarray
    uv: np.ndarray
    turned: bool
    told: np.ndarray | None
    answers: dict
    undeformed: np.ndarray | None = None


def stand_ins(placed: list[Placed], divisions: dict, uv: dict, turned: set, undeformed: dict) -> list[StandIn]:
    """Every place of every mesh; `divisions`, and `uv` of their parts, by owner, in the order in which a joined scene
    counts triangles, the owners that are `turned`, and `undeformed` positions of those that are deformed."""
    counted, made = dict.fromkeys(uv, 0), []
    ends = {owner: np.concatenate(([0], np.cumsum(division.count**2))) for owner, division in divisions.items()}
    for item in placed:
        count = len(item.mesh.triangles)
        for owner, matrix, instance, told, answers in zip(
                item.owners.tolist(), item.matrices, item.instances.tolist(), item.told, item.answers, strict=True):
            part = slice(counted[owner], counted[owner] + count)
            counted[owner] += count
            first, last = ends[owner][[part.start, part.stop]]
            made.append(StandIn(owner, item.mesh, matrix, divisions[owner].count[part], uv[owner][first:last],
                                owner in turned, told if instance else None, answers,
                                _of_its_own(undeformed, owner, item.mesh, instance)))
    return made


def _of_its_own(undeformed: dict, owner: int, mesh: LocalMesh, instance: bool) -> np.ndarray | None:
    found = undeformed.get(owner)
    return None if instance or found is None or len(found) != len(mesh.positions) else found


def new_object(source: bpy.types.Object, stand: StandIn, mesh: bpy.types.Mesh) -> bpy.types.Object:
    """The object with that mesh, standing where the source stands and told from others as it is."""
    if stand.told is None and source.type == "MESH":
        obj = source.copy()
        obj.animation_data_clear()
        obj.modifiers.clear()
        obj.constraints.clear()
        obj.parent = None
        obj.data = mesh
        for slot in obj.material_slots:
            slot.link = "DATA"
        obj.instance_type = "NONE"
        obj.hide_render = False
        # in mirrors it is an object as any other
        obj.is_shadow_catcher = obj.is_holdout = False
    else:
        obj = bpy.data.objects.new(UV_MAP, mesh)
        if stand.told is None:
            obj.pass_index, obj.color = source.pass_index, source.color
        else:
            number, index, *colour = stand.told.tolist()
            obj.pass_index, obj.color, obj[RANDOM] = int(index), colour, 1.0 + number
    for question, value in stand.answers.items():
        obj[answer_name(question)] = value
    obj.matrix_world = Matrix(stand.matrix.tolist())
    if stand.undeformed is not None:
        triangles = stand.mesh.triangles[:, _joined(stand)]
        keep_undeformed(obj, _vertices(stand.undeformed, triangles, divided(stand.count))[0])
    return obj


def swap_names(one: bpy.types.Object, other: bpy.types.Object) -> None:
    """What is random by an object goes by its name."""
    first, second = one.name, other.name
    one.name = f"{UV_MAP} {second}"
    other.name, one.name = first, second


def new_meshes(stands: list[StandIn]) -> Steps[list]:
    """The mesh of each of them, in two steps each; closed at any step, or after an error, none is left."""
    made: list = []
    try:
        for number, stand in enumerate(stands):
            yield number / len(stands), ""
            mesh, normals = _new_mesh(stand)
            made.append(mesh)
            # takes as long as all before it
            yield (number + 0.5) / len(stands), ""
            compat.split_normals(mesh, normals)
    except BaseException:
        bpy.data.batch_remove(still_there(made))
        raise
    return made


def _new_mesh(stand: StandIn) -> tuple[bpy.types.Mesh, np.ndarray]:
    """The mesh as parts of triangles, each with room of its own in the picture, and the normals of its corners."""
    local, division = stand.mesh, divided(stand.count)
    joined = _joined(stand)
    order = joined if not stand.turned else joined[:1] + joined[:0:-1]
    positions, vertices = _vertices(local.positions, local.triangles[:, joined], division)
    corners = local.corners[:, joined]
    uv_maps = [entry for entry in in_order(local.uv_maps, local.active_uv) if entry[0] != UV_MAP]
    layers = [*((name, "FLOAT2", values) for name, values in uv_maps[:MOST_UV_MAPS - 1]), (UV_MAP, "FLOAT2", None),
              *((name, kind, values) for name, (kind, values) in in_order(local.colours, local.active_colour)),
              *((name, kind, values) for name, (kind, values) in local.numbers.items())]
    mesh = bpy.data.meshes.new(UV_MAP)
    write_mesh(mesh, MeshArrays(
        np.zeros(3), positions, vertices[:, order].astype(np.int32),
        (Attribute("material_index", "INT", "FACE", local.material_index[division.owner]),
         *(Attribute(name, kind, "CORNER", (stand.uv if values is None else division.values(values[corners]))[:, order])
           for name, kind, values in layers)), list(local.materials or (None,))))
    mesh.uv_layers[UV_MAP].active = True
    mesh.polygons.foreach_set("use_smooth", np.ones(len(vertices), dtype=bool))
    normals = division.values(local.normals[:, joined])[:, order]
    mesh.use_auto_texspace = False
    mesh.texspace_location, mesh.texspace_size = local.texture_space
    return mesh, (-normals if stand.turned else normals).reshape(-1, 3)


def _joined(stand: StandIn) -> tuple[int, ...]:
    """The order of a triangle's corners in the joined scene: a transform that turns space inside out turns triangles
    over, there as in Blender."""
    return (0, 2, 1) if np.linalg.det(stand.matrix[:3, :3]) < 0.0 else (0, 1, 2)


def _vertices(positions: np.ndarray, triangles: np.ndarray, division: Division) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) of the vertices of a mesh's parts, its own first, and which of them the parts' corners (p, 3)
    are: what hangs together still does."""
    own = division.weights.max(axis=2) == 1.0
    vertices = np.take_along_axis(triangles[division.owner], division.weights.argmax(axis=2), axis=1)
    _, first, number = first_of(division.lattice[~own])
    vertices[~own] = len(positions) + number
    return np.concatenate((positions, division.values(positions[triangles])[~own][first])), vertices
