"""Families of metaballs that merge: one of them, the basis, has the faces and the resolution of all."""
from __future__ import annotations

import re

import bpy


def basis_of(obj: bpy.types.Object) -> bpy.types.Object:
    """Return the metaball that has the faces of `obj`: the first one of those with the same name but for the number."""
    family, _ = _family(obj)
    alike = [other for other in bpy.data.objects if other.type == "META" and _family(other)[0] == family
             and other.users_scene]
    return min([obj, *alike], key=lambda other: (_family(other)[1], other != obj))


def is_part(obj: bpy.types.Object) -> bool:
    """Return True for a metaball whose faces belong to another object, its basis."""
    return obj.type == "META" and basis_of(obj) != obj


def _family(obj: bpy.types.Object) -> tuple[str, int]:
    family, number = re.fullmatch(r"(.*?)(?:[._](\d+))?", obj.name, re.DOTALL).groups()
    return family, int(number or 0)
