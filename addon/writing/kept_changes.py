"""Changes that the user made to a result, kept when it is generated again: its transform and its replaced materials.
Visibility, names, parents and modifiers are kept anyway.
"""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .landmarks import applied_to, note_landmarks

PREVIEW = "reflection_mesh_preview"  # custom property of preview materials, shown until there is light
NEARLY = 1e-6   # relative tolerance of a transform's numbers, which Blender rounds
NEARLY_APPLIED = 1e-5     # the same for transforms computed from vertices


@dataclass(frozen=True)
class Changes:
    """Changes of one result since it was generated.

    Attributes
    ----------
    moved : mathutils.Matrix or None
        Transform in world space by which it was moved; None if it was not moved.
    materials : list of (bpy.types.Material or None, str, bpy.types.Material or None)
        For each replaced material the generated one, where it was replaced ("DATA" or "OBJECT"), and the new one.
    lost : list of str
        Names of changes that another mesh cannot keep.
    """

    moved: Matrix | None
    materials: list
    lost: list


def changes_of(obj: bpy.types.Object) -> Changes:
    """Return the user's changes of a result. Return no changes if it does not know how it was generated."""
    record = obj.reflection_mesh
    lost = [what for what, there in (("shape keys", obj.data.shape_keys), ("vertex groups", len(obj.vertex_groups)))
            if there]
    return Changes(_moved(obj), _replaced(obj) if len(record.materials) else [], lost)


def _moved(obj: bpy.types.Object) -> Matrix | None:
    record = obj.reflection_mesh
    basis = np.array(record.basis).reshape(4, 4)
    unmoved = Matrix.Translation(Vector(record.origin))
    if not basis.any() or _same(basis, obj.matrix_basis):
        return None
    # an applied transform is in the mesh instead, and has moved nothing
    applied = applied_to(obj)
    stands, nearly = obj.matrix_world @ applied, NEARLY if applied == Matrix.Identity(4) else NEARLY_APPLIED
    # a parent's movement since then moved both
    above = obj.matrix_world @ obj.matrix_basis.inverted_safe()
    left = above @ Matrix(basis.tolist())
    if _same(unmoved, stands, nearly) or _same(left, stands, nearly):
        return None
    return stands @ left.inverted_safe()


def _same(one, other, nearly: float = NEARLY) -> bool:
    one, other = np.array(one), np.array(other)
    return bool((np.abs(one - other) <= nearly * (1.0 + np.abs(other))).all())


def _replaced(obj: bpy.types.Object) -> list:
    record, found = obj.reflection_mesh, []
    for slot, material, made in zip(obj.material_slots, obj.data.materials, record.materials):
        if (slot.link == "OBJECT" and slot.material not in (None, record.light_material, made.material)
                and PREVIEW not in slot.material):
            found.append((made.material, "OBJECT", slot.material))
        if material != made.material:
            found.append((made.material, "DATA", material))
    return found


def place(obj: bpy.types.Object, origin: np.ndarray, changes: Changes) -> None:
    """Put a result where it was generated, and apply the user's movement, if any."""
    matrix = Matrix.Translation(origin)
    record = obj.reflection_mesh
    obj.matrix_world = matrix
    record.origin = matrix.translation
    record.basis = [value for row in obj.matrix_basis for value in row]
    note_landmarks(obj)
    if changes.moved is not None:
        obj.matrix_world = changes.moved @ matrix


def put_back_materials(obj: bpy.types.Object, materials: list, changes: Changes) -> list[str]:
    """Replace materials of a result's new mesh as the user had replaced them before it was generated again.

    Parameters
    ----------
    obj : bpy.types.Object
        The result. Its mesh is new and has `materials`. They are recorded in `obj.reflection_mesh.materials`, from
        which `changes_of` tells later what the user has replaced.
    materials : list of bpy.types.Material or None
        The generated materials by slot.
    changes : Changes
        The user's changes of the earlier mesh.

    Returns
    -------
    list of str
        One sentence on the changes that are lost, or an empty list.
    """
    record = obj.reflection_mesh
    record.materials.clear()
    for material in materials:
        record.materials.add().material = material
    lost = list(changes.lost)
    for made, link, material in changes.materials:
        if made not in materials:
            lost.append(f"the material '{material.name}'" if material else "an empty material slot")
        for number, other in enumerate(materials):
            if other != made:
                continue
            if link == "DATA":
                obj.data.materials[number] = material
            else:
                obj.material_slots[number].link = "OBJECT"
                obj.material_slots[number].material = material
    if not lost:
        return []
    return [f"'{obj.name}' shows other faces than before, and has lost what was made for those: {', '.join(lost)}."]


def place_of(obj: bpy.types.Object) -> Matrix:
    """Return the matrix from a result's mesh to world space at the place where it was generated, even if it was moved
    since.
    """
    record = obj.reflection_mesh
    if not any(record.basis):
        return obj.matrix_world
    return Matrix.Translation(Vector(record.origin)) @ applied_to(obj).inverted_safe()
