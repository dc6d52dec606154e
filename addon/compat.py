"""The differences between Blender 4.2, 4.5 and 5.2, in one place."""
from __future__ import annotations

import bpy


def uses_nodes(material: bpy.types.Material) -> bool:
    """Whether a node tree makes the material; from Blender 5.0 on one always does, and the switch is deprecated."""
    if bpy.app.version >= (5, 0, 0):
        return material.node_tree is not None
    return material.use_nodes and material.node_tree is not None
