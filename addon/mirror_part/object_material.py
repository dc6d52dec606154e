"""The material that shows light kept with objects as a mirror would show it."""
from __future__ import annotations

from collections.abc import Sequence

import bpy

from .. import compat
from ..faults import AllOrNothing, remove_new
from ..reading.materials import one_output, surface_shader
from ..writing import UV_MAP, show_unblurred
from ..writing.nodes.opened_groups import open_groups
from .mirror_part import MirrorPart, Surroundings, copied_shaders


def new_object_material(name: str, image: bpy.types.Image, mirror: Sequence[bpy.types.Material | None], opaque: bool,
                        around: Surroundings, whole: AllOrNothing) -> bpy.types.Material:
    """A material that shows light that stays with objects as those of a `mirror` would: tinted, by Fresnel, mixed with
    what else they are; `None` shows all of the light.

    Tints go by the true angle at the mirror, which the attribute `NORMAL` tells, and several materials by the attribute
    `MATERIAL`. EEVEE has nodes of its own.
    """
    material, shaders = _merged(name, mirror, whole)
    tree = material.node_tree
    own = list(tree.nodes)
    where = tree.nodes.new("ShaderNodeUVMap")
    where.uv_map = UV_MAP
    light = tree.nodes.new("ShaderNodeTexImage")
    light.name, light.image, light.interpolation, light.extension = image.name, image, "Linear", "EXTEND"
    tree.links.new(where.outputs[0], light.inputs["Vector"])
    build = MirrorPart(tree, light.outputs["Color"], around)
    shown = build.surface(mirror, shaders, own)
    output = one_output(tree)
    if not opaque:
        shown = build.mixed(light.outputs["Alpha"], build.clear(), shown)
    tree.links.new(shown, output.inputs["Surface"])
    for name_ in ("Displacement", "Volume"):
        for link in list(output.inputs[name_].links):
            tree.links.remove(link)
    show_unblurred(tree, [light], output, whole)
    for_cycles = build.before_the_mirror(shown, mirror)
    if for_cycles != shown:
        build.feed(for_cycles, build.add("ShaderNodeOutputMaterial", target="CYCLES").inputs["Surface"])
    for node in tree.nodes:
        node.select = node == light
    tree.nodes.active = light
    return material


def _merged(name: str, mirror: Sequence[bpy.types.Material | None], whole: AllOrNothing
            ) -> tuple[bpy.types.Material, list[bpy.types.Node | None]]:
    """A new material with the nodes of all that have some, and the shader of each, None where it has none."""
    with_nodes = [one for one in mirror if one is not None and compat.uses_nodes(one)]
    material = with_nodes[0].copy() if with_nodes else bpy.data.materials.new(name)
    whole.undo(remove_new, material)
    material.name = name
    tree = compat.use_nodes(material)
    if not with_nodes:
        tree.nodes.clear()
        tree.nodes.new("ShaderNodeOutputMaterial")
    open_groups(tree)
    shader_of = {one: surface_shader(tree) for one in with_nodes[:1]} | copied_shaders(with_nodes[1:], tree)
    return material, [shader_of.get(one) for one in mirror]
