"""What the user has changed on a result, kept when it is generated anew: where it was moved to, and which materials it
was given. Hidden, renamed, parented and modified it stays without any help."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .landmarks import applied_to, note_landmarks

PREVIEW = "reflection_mesh_preview"  # custom property of the materials that are shown before there is light
NEARLY = 1e-6   # of a transform's numbers, which Blender rounds
NEARLY_APPLIED = 1e-5     # the same, told by vertices


@dataclass(frozen=True)
class Changes:
    """What was changed on one result since it was generated.

    Attributes
    ----------
    moved : mathutils.Matrix or None
        By what it was moved in world space; None where it was not.
    materials : list of (bpy.types.Material or None, str, bpy.types.Material or None)
        As generated, where it was replaced ("DATA" or "OBJECT"), and by what.
    lost : list of str
        What has no place on another mesh.
    """

    moved: Matrix | None
    materials: list
    lost: list


def changes_of(obj: bpy.types.Object) -> Changes:
    """What the user has changed on a result; nothing where it does not know how it was generated."""
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
    # a transform that was applied is in the mesh instead, and has moved nothing
    applied = applied_to(obj)
    stands, nearly = obj.matrix_world @ applied, NEARLY if applied == Matrix.Identity(4) else NEARLY_APPLIED
    # what a parent did since then moved it in both
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
    """Put a result where it was generated, or as far from there as it was moved."""
    matrix = Matrix.Translation(origin)
    record = obj.reflection_mesh
    obj.matrix_world = matrix
    record.origin = matrix.translation
    record.basis = [value for row in obj.matrix_basis for value in row]
    note_landmarks(obj)
    if changes.moved is not None:
        obj.matrix_world = changes.moved @ matrix


def put_back_materials(obj: bpy.types.Object, materials: list, changes: Changes) -> list[str]:
    """Note the materials of a result's new mesh and replace them again as the user did; returns a sentence on what
    could not be kept, or none."""
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
    """What takes a result's mesh to where it was generated, in world space, wherever it was moved since."""
    record = obj.reflection_mesh
    if not any(record.basis):
        return obj.matrix_world
    return Matrix.Translation(Vector(record.origin)) @ applied_to(obj).inverted_safe()
