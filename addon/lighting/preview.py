"""Before a result is lit: materials in the colours of its sources and the mirror's tint, which no lamp touches."""
from __future__ import annotations

import bpy

from ..blender_data import compat
from ..blender_data.mirror_materials import surface_shader
from ..faults import AllOrNothing
from .needs_light import TINTS, needs_light

WHITE = (1.0, 1.0, 1.0)
# shaders that go on doing what they do
KEPT = {"MIX_SHADER", "ADD_SHADER", "BSDF_TRANSPARENT", "HOLDOUT", "GROUP", "OUTPUT_MATERIAL", "OUTPUT_AOV", "REROUTE"}


def show_preview(result: bpy.types.Object, whole: AllOrNothing) -> None:
    """Let a result that is not lit, and would look wrong, show the plain colours of its sources."""
    if not needs_light(result):
        return
    tint = _tint(result.reflection_mesh.mirror)
    for slot, source in zip(result.material_slots, result.data.materials, strict=False):
        made = _preview_of(source, tint)
        whole.undo(bpy.data.materials.remove, made)
        slot.link, slot.material = "OBJECT", made


def _tint(mirror: bpy.types.Object | None) -> tuple:
    """The colour of a mirror, where it is one everywhere."""
    for slot in mirror.material_slots if mirror is not None else ():
        if slot.material is not None and compat.uses_nodes(slot.material):
            shader = surface_shader(slot.material.node_tree)
            socket = shader and shader.inputs.get(TINTS.get(shader.type, ("",))[0])
            if socket and not socket.is_linked:
                return tuple(socket.default_value[:3])
    return WHITE


def _preview_of(source: bpy.types.Material | None, tint: tuple) -> bpy.types.Material:
    name = f"{source.name if source else 'Plain'} Preview"
    if source is not None and compat.uses_nodes(source):
        made = source.copy()
        made.name = name
    else:
        made = bpy.data.materials.new(name)
        colour = source.diffuse_color if source else (0.8, 0.8, 0.8, 1.0)
        compat.use_nodes(made).nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    made.reflection_mesh.preview = True
    tree = made.node_tree
    for node in [node for node in tree.nodes if node.outputs and node.outputs[0].type == "SHADER"]:
        if node.type not in KEPT:
            _replace(tree, node, tint)
    return made


def _replace(tree: bpy.types.NodeTree, node: bpy.types.Node, tint: tuple) -> None:
    """Put the emission of a shader's colour in its place, transparent where that is."""
    glow, times = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeMix")
    times.data_type, times.blend_type = "RGBA", "MULTIPLY"
    times.inputs[0].default_value, times.inputs[7].default_value = 1.0, (*tint, 1.0)
    _hand_on(tree, node.inputs.get("Base Color") or node.inputs.get("Color"), times.inputs[6])
    tree.links.new(times.outputs[2], glow.inputs["Color"])
    if node.type == "EMISSION":
        _hand_on(tree, node.inputs["Strength"], glow.inputs["Strength"])
    shown, alpha = glow.outputs[0], node.inputs.get("Alpha")
    if alpha is not None and (alpha.is_linked or alpha.default_value < 1.0):
        clear, mixed = tree.nodes.new("ShaderNodeBsdfTransparent"), tree.nodes.new("ShaderNodeMixShader")
        _hand_on(tree, alpha, mixed.inputs[0])
        tree.links.new(clear.outputs[0], mixed.inputs[1])
        tree.links.new(shown, mixed.inputs[2])
        shown = mixed.outputs[0]
    for target in [link.to_socket for link in node.outputs[0].links]:
        tree.links.new(shown, target)
    tree.nodes.remove(node)


def _hand_on(tree: bpy.types.NodeTree, source: bpy.types.NodeSocket | None, target: bpy.types.NodeSocket) -> None:
    """Give a socket what another has: its link, or its value."""
    if source is None:
        return
    if source.is_linked:
        tree.links.new(source.links[0].from_socket, target)
    else:
        target.default_value = source.default_value
