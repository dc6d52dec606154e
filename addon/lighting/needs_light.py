"""Find results that look right without computed light: the source objects emit light, and neither mirror nor fog
attenuates it.
"""
from __future__ import annotations

import bpy
import numpy as np

from .. import compat
from ..reading import has_fog, mirrors_of
from ..reading.materials import all_materials_of, emits_alike, is_mirror, surface_shader

WHITE = 0.999
TINTS = {"BSDF_GLOSSY": ("Color",), "BSDF_PRINCIPLED": ("Base Color", "Specular Tint")}
# a metal that is white, sharp and nothing else shows all of the light, from any side
PLAIN = {"Metallic": 1.0, "Roughness": 0.0, "Alpha": 1.0, "Transmission Weight": 0.0, "Coat Weight": 0.0,
         "Sheen Weight": 0.0, "Emission Strength": 0.0, "Thin Film Thickness": 0.0}


def needs_light(result: bpy.types.Object) -> bool:
    """Return True if a result looks different from its mirror without computed light."""
    parts = mirrors_of(result)
    if not parts or not only_emits(result):
        return True
    mirrors = [material for part in parts for material in filter(is_mirror, all_materials_of(part))]
    # fog is looked for last: objects are many
    return not mirrors or not all(map(is_plain, mirrors)) or any(map(has_fog, result.users_scene))


def only_emits(result: bpy.types.Object) -> bool:
    """Return True if all source materials of a reflection emit the same light in all directions. A render of their
    light has no noise, unless there is fog, which is not looked for here.
    """
    return all(map(emits_alike, _shown(result)))


def is_plain(material: bpy.types.Material) -> bool:
    """Return True if a material only reflects, and does so sharply and without a tint."""
    shader = surface_shader(material.node_tree) if compat.uses_nodes(material) else None
    if shader is None or shader.type not in TINTS:
        return False
    tints = [shader.inputs[name] for name in TINTS[shader.type] if name in shader.inputs]
    values = [(shader.inputs[name], value) for name, value in PLAIN.items() if name in shader.inputs]
    # the strength of an emission of black says nothing
    dark = "Emission Color" in shader.inputs and max(shader.inputs["Emission Color"].default_value[:3]) == 0.0
    return (all(not tint.is_linked and min(tint.default_value[:3]) >= WHITE for tint in tints)
            and all(not socket.is_linked and (socket.default_value == value or (dark and "Emission" in socket.name))
                    for socket, value in values)
            and not (shader.inputs["Normal"].is_linked))


def _shown(result: bpy.types.Object) -> list:
    """The materials of the faces or points of a result."""
    mesh = result.data
    known = mesh.attributes.get("material_index" if len(mesh.polygons) else "source_material")
    if known is None:
        return list(mesh.materials)
    index = np.empty(len(known.data), dtype=np.int32)
    known.data.foreach_get("value", index)
    # counted, which takes a tenth of what sorting does
    return [mesh.materials[number] if number < len(mesh.materials) else None
            for number in np.flatnonzero(np.bincount(index))]
