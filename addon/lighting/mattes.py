"""Mattes: passes that tell for each pixel how much of it a reflection fills with one object, as shader AOVs.

An object asks for its matte by a property. Its share is an attribute of each result that shows it, 1 on its faces, and
the results' own materials, those of light and previews, put that out. Materials of the user are not touched.
"""
from __future__ import annotations

from collections.abc import Iterable

import bpy
import numpy as np

from ...core import ReflectionError
from ..faults import AllOrNothing
from ..lamps import lamps_that_show
from ..reading import is_result, numbers, read_view
from .lit_results import is_lit
from .preview import MARK, show_previews, shows_preview

PREFIX = "Matte "
OWN = f"Reflection {PREFIX}"    # how the nodes and attributes are called that are made here
LONGEST = 63    # bytes of a pass's name
SOURCES = "source_object"


def matte_name(obj: bpy.types.Object) -> str:
    """Return what the pass of an object is called; Blender allows no dots there."""
    return (PREFIX + obj.name.replace(".", "_")).encode()[:LONGEST].decode(errors="ignore")


def update_mattes(context: bpy.types.Context) -> None:
    """Let the results of the scene show the mattes that are asked for, and nothing of those that are not any more."""
    results = [obj for obj in context.scene.objects if is_result(obj) and obj.library is None and obj.type == "MESH"]
    asked = {result: _asked(result) for result in results}
    _show_own_materials(context, [result for result in results if asked[result] and SOURCES in result.data.attributes])
    shown: dict[bpy.types.Material, dict] = {}
    for result, wanted in asked.items():
        _write_shares(result.data, wanted)
        for material in _own_materials(result):
            shown.setdefault(material, {}).update(dict.fromkeys(wanted))
    for material, wanted in shown.items():
        _put_out(material.node_tree, wanted)
    _set_passes(context.scene, {name for wanted in shown.values() for name in wanted})


def lacks_mattes(result: bpy.types.Object) -> bool:
    """Return True if objects ask for mattes in a result that does not know which object a face shows."""
    return bool(_asked(result)) and SOURCES not in result.data.attributes


def _asked(result: bpy.types.Object) -> dict[str, list[int]]:
    """Return the numbers of the sources that ask for a matte, by its name."""
    found: dict[str, list[int]] = {}
    for number, source in enumerate(result.reflection_mesh.sources):
        if source.object is not None and source.object.reflection_mesh.matte:
            found.setdefault(matte_name(source.object), []).append(number)
    return found


def _show_own_materials(context: bpy.types.Context, results: list) -> None:
    """Let results that show the user's materials show previews instead."""
    bare = [result for result in results if not (is_lit(result) or shows_preview(result))]
    if not bare:
        return
    try:
        view = read_view(context)
    except ReflectionError:
        # nothing is rendered without a camera
        return
    with AllOrNothing() as whole:
        show_previews(bare, view, lamps_that_show(context), whole)


def _own_materials(result: bpy.types.Object) -> list:
    """Return the materials that a result shows and that are not the user's."""
    light = result.reflection_mesh.light_material
    return [slot.material for slot in result.material_slots if slot.material is not None
            and slot.material.library is None and (slot.material == light or MARK in slot.material)]


def _write_shares(mesh: bpy.types.Mesh, wanted: dict[str, list[int]]) -> None:
    own = {f"Reflection {name}": numbers_of for name, numbers_of in wanted.items()}
    for name in [one.name for one in mesh.attributes if one.name.startswith(OWN) and one.name not in own]:
        mesh.attributes.remove(mesh.attributes[name])
    if SOURCES not in mesh.attributes:
        return
    source = numbers(mesh, SOURCES)
    for name, numbers_of in own.items():
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", mesh.attributes[SOURCES].domain)
        attribute.data.foreach_set("value", np.isin(source, numbers_of).astype(np.float32))


def _put_out(tree: bpy.types.NodeTree, wanted: Iterable[str]) -> None:
    """Let a material put out these mattes, and no others."""
    for node in [node for node in tree.nodes if node.name.startswith(OWN)]:
        tree.nodes.remove(node)
    for row, name in enumerate(wanted):
        share, out = tree.nodes.new("ShaderNodeAttribute"), tree.nodes.new("ShaderNodeOutputAOV")
        share.attribute_name, out.aov_name = f"Reflection {name}", name
        share.name, out.name = f"{OWN}Share", f"{OWN}Output"
        share.location, out.location = (600.0, -200.0 * row), (800.0, -200.0 * row)
        tree.links.new(share.outputs["Fac"], out.inputs["Value"])


def _set_passes(scene: bpy.types.Scene, wanted: set[str]) -> None:
    """Let the view layers have the passes that are wanted, and none of those that they had for others."""
    record = scene.reflection_mesh
    before = set(record.mattes.split("\n")) - {""}
    for layer in scene.view_layers:
        there = {aov.name: aov for aov in layer.aovs}
        for name in sorted(wanted - set(there)):
            aov = layer.aovs.add()
            aov.name, aov.type = name, "VALUE"
            before.add(name)
        for name in before - wanted:
            if name in layer.aovs:
                layer.aovs.remove(layer.aovs[name])
    record.mattes = "\n".join(sorted(before & wanted))
