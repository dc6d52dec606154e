"""Metaballs that melt together: one of them, the basis, has the faces and the resolution of all."""
from __future__ import annotations

import re

import bpy


def basis_of(obj: bpy.types.Object) -> bpy.types.Object:
    """The metaball that has the faces of `obj`: of those that are called alike but for a number the first."""
    family, _ = _family(obj)
    alike = [other for other in bpy.data.objects if other.type == "META" and _family(other)[0] == family
             and other.users_scene]
    return min([obj, *alike], key=lambda other: (_family(other)[1], other != obj))


def is_part(obj: bpy.types.Object) -> bool:
    """Whether an object is a metaball whose faces another one has."""
    return obj.type == "META" and basis_of(obj) != obj


def _family(obj: bpy.types.Object) -> tuple[str, int]:
    family, number = re.fullmatch(r"(.*?)(?:[._](\d+))?", obj.name, re.DOTALL).groups()
    return family, int(number or 0)
