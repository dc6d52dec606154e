"""What materials become while the light on them is baked."""
from __future__ import annotations

import bpy

from ....core import View
from ... import compat
from ...mirror_part import as_mirrors_see, hide_own_light, show_opacity, turn_over, without_openings
from ...writing import UV_MAP
from .true_answers import answer_truly, own_groups


def new_target(material: bpy.types.Material | None, view: View, how: tuple[bool, bool], made: list, switches: list,
               ) -> bpy.types.Material:
    """A copy of a material that bakes into the image, `how`: its light, as if nothing went through, or how opaque it
    is, and of what is turned over; it and its groups are `made`, and `switches` put its own light out."""
    opacity, backs = how
    target = bpy.data.materials.new(UV_MAP) if material is None else material.copy()
    made.append(target)
    if not compat.uses_nodes(target):
        compat.use_nodes(target)
    tree, groups = target.node_tree, own_groups(target.node_tree)
    made += groups
    for part in (tree, *groups):
        answer_truly(part, view)
        if backs:
            turn_over(part)
        as_mirrors_see(part)
        if not opacity:
            switches += hide_own_light(part)
    (show_opacity if opacity else without_openings)(tree)
    node = tree.nodes.new("ShaderNodeTexImage")
    for other in tree.nodes:
        other.select = other == node
    tree.nodes.active = node
    return target
