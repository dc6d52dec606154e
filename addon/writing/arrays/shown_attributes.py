"""Find the attributes of a result that are visible: those that its materials read, but not the method's own records."""
from __future__ import annotations

from collections.abc import Iterator

import bpy

from ... import compat
from ...reading.materials import all_nodes, asked_attributes, emits
from .later_mirrors import ARRIVAL, LATER_COSINE, LATER_MATERIAL, NORMAL

# attributes that record how the result was computed; no shader reads them by default
OF_METHOD = frozenset({"reflected_position", "mirror_position", "path_length", "image_parity", "source_object",
                       "source_face", "bounces", "mirror_face", NORMAL, ARRIVAL})
LATER = {LATER_MATERIAL.format(""), LATER_COSINE.format("")}
# nodes that may read the active UV map, and nodes that read normals
READS_UV = {"TEX_COORD", "UVMAP", "NORMAL_MAP", "TANGENT", "TEX_IMAGE", "TEX_GABOR", "SCRIPT"}
READS_NORMALS = {"TEX_COORD", "NEW_GEOMETRY", "FRESNEL", "LAYER_WEIGHT", "BUMP", "NORMAL_MAP", "TANGENT", "BEVEL",
                 "AMBIENT_OCCLUSION", "SCRIPT"}


def shown_attributes(attributes: tuple, materials: list) -> tuple:
    """Return the attributes of a result that `materials` read. The first UV map and the first colour attribute are the
    active ones.
    """
    asked = asked_attributes(materials)
    types = {node.type for node in _nodes(materials)}
    nameless = {node.type for node in _nodes(materials)
                if node.type == "VERTEX_COLOR" and not node.layer_name}
    uv_maps = [entry.name for entry in attributes if entry.kind == "FLOAT2"]
    colours = [entry.name for entry in attributes if "COLOR" in entry.kind]
    unread = OF_METHOD | {*uv_maps, *colours}
    unread |= {entry.name for entry in attributes if entry.name.rstrip("0123456789") in LATER}
    if types & READS_UV:
        unread -= set(uv_maps[:1])
    if nameless:
        unread -= set(colours[:1])
    if not types & READS_NORMALS and all(map(emits, materials)):
        unread |= {compat.normals_attribute()}
    return tuple(entry for entry in attributes if entry.name in asked or entry.name not in unread)


def _nodes(materials: list) -> Iterator[bpy.types.Node]:
    for material in materials:
        if material is not None and compat.uses_nodes(material):
            yield from all_nodes(material.node_tree)
