"""Sources whose colours go by their islands: Cycles tells these apart by how a mesh numbers its vertices and edges, and
what is baked has others."""
from __future__ import annotations

import bpy

from ..reading import materials_of
from ..reading.materials import all_nodes


def random_by_island(results: list) -> list[str]:
    """The names of the sources of `results` with a material that asks for Random Per Island."""
    sources = {entry.object for result in results for entry in result.reflection_mesh.sources} - {None}
    return sorted(source.name for source in sources if any(map(_asks, materials_of(source))))


def _asks(material: bpy.types.Material | None) -> bool:
    return material is not None and material.node_tree is not None and any(
        node.type == "NEW_GEOMETRY" and node.outputs["Random Per Island"].is_linked
        for node in all_nodes(material.node_tree))
