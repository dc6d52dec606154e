"""Faces that show the world on reflections that are not lit, and the material that looks the world up."""
from __future__ import annotations

import bpy

from ...core import View
from .. import compat
from ..faults import AllOrNothing, remove_new
from ..writing import PREVIEW
from ..writing.nodes.copied_nodes import copied
from ..writing.nodes.opened_groups import open_groups
from ..writing.nodes.shader_builder import ShaderBuilder, given
from .world_faces import add_world_faces, set_tail

NAME = "Reflection World"
BY_DIRECTION = {"TEX_ENVIRONMENT", "TEX_SKY", "TEX_NOISE", "TEX_GRADIENT", "TEX_CHECKER", "TEX_MAGIC", "TEX_VORONOI",
                "TEX_WAVE", "TEX_BRICK", "TEX_WHITE_NOISE", "TEX_GABOR"}    # nodes that take it if they get nothing


def show_world(result: bpy.types.Object, view: View, world: bpy.types.World | None, whole: AllOrNothing) -> None:
    """Let a reflection that was generated just now have faces that show a world by its own shader."""
    mesh, record, before = result.data, result.reflection_mesh, len(result.data.polygons)
    add_world_faces(mesh, result, view, record.hidden_faces)
    if len(mesh.polygons) == before:
        return
    material = world_material(world)
    whole.undo(remove_new, material)
    mesh.materials.append(material)
    record.materials.add().material = material
    if "material_index" not in mesh.attributes:
        mesh.attributes.new("material_index", "INT", "FACE")
    set_tail(mesh, "material_index", before, len(mesh.materials) - 1)
    record.faces = len(mesh.polygons)


def world_material(world: bpy.types.World | None) -> bpy.types.Material:
    """Return a material that shows what a world's shader shows in the direction in which the mirror sees it."""
    material = bpy.data.materials.new(NAME)
    material[PREVIEW] = True
    tree = compat.use_nodes(material)
    tree.nodes.clear()
    build = ShaderBuilder(tree)
    output = build.add("ShaderNodeOutputMaterial")
    if world is None or not compat.uses_nodes(world):
        build.feed(build.glow((0.0, 0.0, 0.0, 1.0) if world is None else (*world.color, 1.0)), output.inputs["Surface"])
        return material
    ends = [build.add("ShaderNodeAttribute", attribute_name=name).outputs["Vector"]
            for name in ("reflected_position", "mirror_position")]
    direction = build.vector("NORMALIZE", build.vector("SUBTRACT", *ends))
    known = world.copy()
    try:
        open_groups(known.node_tree)
        nodes = [node for node in known.node_tree.nodes if node.type not in {"OUTPUT_WORLD", "FRAME"}]
        made = copied(nodes, tree)
        shown = known.node_tree.get_output_node("CYCLES") or known.node_tree.get_output_node("ALL")
        surface = shown.inputs["Surface"].links[0] if shown and shown.inputs["Surface"].links else None
        if surface is not None:
            place = list(surface.from_node.outputs).index(surface.from_socket)
            build.feed(made[surface.from_node].outputs[place], output.inputs["Surface"])
    finally:
        bpy.data.worlds.remove(known)
    for node in made.values():
        _look_along(build, node, direction)
    return material


def _look_along(build: ShaderBuilder, node: bpy.types.Node, direction: bpy.types.NodeSocket) -> None:
    """Let a node of a world's shader go by a direction, and shine from a surface."""
    if node.type == "TEX_COORD":
        for name, way in (("Generated", direction), ("Object", direction), ("Normal", direction)):
            for link in list(node.outputs[name].links):
                build.feed(way, link.to_socket)
    elif node.type == "NEW_GEOMETRY":
        back = build.vector("SCALE", direction, Scale=-1.0)
        for name, way in (("Position", direction), ("Normal", back), ("Incoming", back)):
            for link in list(node.outputs[name].links):
                build.feed(way, link.to_socket)
    elif node.type in BY_DIRECTION and not node.inputs["Vector"].is_linked:
        build.feed(direction, node.inputs["Vector"])
    elif node.type == "BACKGROUND":
        glow = build.add("ShaderNodeEmission")
        for name in ("Color", "Strength"):
            build.feed(given(node.inputs[name]), glow.inputs[name])
        for link in list(node.outputs[0].links):
            build.feed(glow.outputs[0], link.to_socket)
