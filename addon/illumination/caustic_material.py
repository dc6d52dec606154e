"""Materials that add light to what lies behind them: the receiver's colour times the light that falls there."""
from __future__ import annotations

import math
from dataclasses import replace

import bpy

from .. import compat
from ..faults import AllOrNothing
from ..reading.materials import shown_output
from ..writing.nodes.muted_nodes import take_out_muted
from ..writing.nodes.shader_builder import ShaderBuilder
from .diffuse_colour import GREY, DiffuseColour, diffuse_colour
from .mirrors import PER_COLOUR, Tint
from .receiver_places import MARK, asks_for_more, forget_groups, show_by_places

LIGHT = "caustic_light"
"""The attribute with red, green and blue of the light, in W/m2."""
VEIL = (1.0, 1.0, 0.9, 0.15)
"""The colour in viewports in Solid, which show where light falls and not how much of it."""
UNSEEN = "lit_unseen"
"""The attribute with 1 on faces that light what the camera does not see, where there are any."""


def adds_light(receiver: bpy.types.Material | None, stains: list[tuple[Tint, bpy.types.NodeTree]],
               whole: AllOrNothing, unseen: bool = False) -> tuple[bpy.types.Material, bool]:
    """Return a transparent material that emits the caustic light times the receiver's diffuse colour, and True if the
    colour is fully known. The colour comes from copies of the receiver's nodes.

    `stains` are textured tints of the mirror, with the groups that compute their colours. Set `unseen` if some
    receivers are hidden from the camera.
    """
    name = f"{receiver.name if receiver else 'Default'} Caustics"
    found = DiffuseColour(GREY if receiver is None else tuple(receiver.diffuse_color))
    if receiver is None or not compat.uses_nodes(receiver):
        material = bpy.data.materials.new(name)
        whole.undo(bpy.data.materials.remove, material)
        tree = compat.use_nodes(material)
    else:
        material = receiver.copy()
        whole.undo(bpy.data.materials.remove, material)
        material.name = name
        tree = material.node_tree
        take_out_muted(tree)
        strange = asks_for_more(tree)
        show_by_places(tree, whole)
        output = shown_output(tree)
        found = DiffuseColour() if output is None else diffuse_colour(tree, output.inputs["Surface"], whole)
        found = replace(found, known=found.known and not (found.by_nodes and strange))
    material[MARK] = True
    material.diffuse_color = VEIL
    strength = _show(tree, found, _thrown(tree, stains))
    if unseen:
        _hide_from_camera(tree, strength)
    material.surface_render_method = "BLENDED"
    material.use_transparency_overlap = True
    material.use_backface_culling = False
    material.cycles.emission_sampling = "NONE"
    return material, found.known


def light_alone(material: bpy.types.Material | None) -> bpy.types.Material | None:
    """Return a copy of a material that adds light, which emits what white paint would reflect of it, to both sides. The
    caller removes it. Return None if the material was not made here in this form.
    """
    if material is None or not material.get(MARK):
        return None
    copy = material.copy()
    tree = copy.node_tree
    # the links that `_show` has made
    both = _behind(tree.get_output_node("ALL"), "ADD_SHADER", "Surface")
    emission = _behind(both, "EMISSION")
    product = _behind(emission, "VECT_MATH")
    if product is None:
        bpy.data.materials.remove(copy)
        return None
    tree.links.new(product.inputs[0].links[0].from_socket, emission.inputs["Color"])
    for link in list(emission.inputs["Strength"].links):
        tree.links.remove(link)
    emission.inputs["Strength"].default_value = 1.0 / math.pi
    return copy


def _behind(node: bpy.types.Node | None, kind: str, socket: str | int = 0) -> bpy.types.Node | None:
    """Return the node of type `kind` that feeds a socket of a node; None if there is none."""
    links = () if node is None else node.inputs[socket].links
    return next((link.from_node for link in links if link.from_node.type == kind), None)


def forget_added_light(materials: list) -> None:
    """Remove those of the materials that were made here and have no users any more."""
    for material in materials:
        if material is not None and material.get(MARK) and material.users == 0:
            bpy.data.materials.remove(material)
    forget_groups()


def _thrown(tree: bpy.types.NodeTree, stains: list[tuple[Tint, bpy.types.NodeTree]]) -> bpy.types.NodeSocket:
    """Return the caustic light: with one colour for each tint, plus the difference to the textured colours."""
    build = ShaderBuilder(tree)
    light = build.add("ShaderNodeAttribute", attribute_name=LIGHT).outputs["Vector"]
    for number, (tint, group) in enumerate(stains):
        true = build.add("ShaderNodeGroup", node_tree=group).outputs[0]
        more = build.vector("SUBTRACT", true, tuple(tint.colour))
        grown = build.add("ShaderNodeAttribute", attribute_name=PER_COLOUR.format(number)).outputs["Vector"]
        light = build.vector("ADD", light, build.vector("MULTIPLY", more, grown))
    return light


def _show(tree: bpy.types.NodeTree, sent: DiffuseColour, light: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Make a tree emit its colour times the light times a share, divided by pi, on top of what lies behind. Emit to the
    lit side only; otherwise the emission would light the receiver. Return the socket with the strength.
    """
    share = sent.share

    def add(kind: str, place: tuple[float, float]) -> bpy.types.Node:
        node = tree.nodes.new(kind)
        node.location = place
        return node
    for node in [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL"]:
        tree.nodes.remove(node)
    product = add("ShaderNodeVectorMath", (200.0, -300.0))
    product.operation = "MULTIPLY"
    emission, clear = add("ShaderNodeEmission", (400.0, -300.0)), add("ShaderNodeBsdfTransparent", (400.0, -450.0))
    both, output = add("ShaderNodeAddShader", (600.0, -300.0)), add("ShaderNodeOutputMaterial", (800.0, -300.0))
    tree.links.new(light, product.inputs[0])
    if isinstance(sent.colour, bpy.types.NodeSocket):
        tree.links.new(sent.colour, product.inputs[1])
    else:
        product.inputs[1].default_value = sent.colour[:3]
    seen, front = add("ShaderNodeNewGeometry", (0.0, -500.0)), add("ShaderNodeMath", (200.0, -500.0))
    known = share / math.pi if isinstance(share, float) else 1.0 / math.pi
    front.operation, front.inputs[0].default_value, front.inputs[2].default_value = "MULTIPLY_ADD", -known, known
    tree.links.new(seen.outputs["Backfacing"], front.inputs[1])
    strength = front
    if not isinstance(share, float):
        strength = add("ShaderNodeMath", (200.0, -650.0))
        strength.operation = "MULTIPLY"
        tree.links.new(front.outputs[0], strength.inputs[0])
        tree.links.new(share, strength.inputs[1])
    tree.links.new(strength.outputs[0], emission.inputs["Strength"])
    clear.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    tree.links.new(product.outputs["Vector"], emission.inputs["Color"])
    tree.links.new(emission.outputs["Emission"], both.inputs[0])
    tree.links.new(clear.outputs["BSDF"], both.inputs[1])
    tree.links.new(both.outputs["Shader"], output.inputs["Surface"])
    return emission.inputs["Strength"]


def _hide_from_camera(tree: bpy.types.NodeTree, strength: bpy.types.NodeSocket) -> None:
    """Emit nothing to the camera from faces on receivers that the camera does not see. Mirrors show these."""
    build = ShaderBuilder(tree)
    asked = build.add("ShaderNodeLightPath").outputs["Is Camera Ray"]
    dark = build.calculated("MULTIPLY", asked, build.add("ShaderNodeAttribute", attribute_name=UNSEEN).outputs["Fac"])
    build.feed(build.calculated("MULTIPLY", strength.links[0].from_socket, build.calculated("SUBTRACT", 1.0, dark)),
               strength)

