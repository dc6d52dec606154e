"""The material that shows light on a reflection, and the images that it shows."""
from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import bpy
import numpy as np

from ... import core
from .. import compat
from ..faults import AllOrNothing, Steps, part, remove_new
from ..files import open_exr
from ..mirror_part import MirrorPart, Surroundings, copied_shaders
from ..reading.materials import is_opaque, one_output, surface_shader
from ..writing import UV_MAP, show_unblurred
from ..writing.nodes.copied_nodes import copied
from ..writing.nodes.opened_groups import open_groups
from ..writing.nodes.shader_builder import ShaderBuilder, cut, given

WRITING = "Writing"
OPAQUE = 0.999
WITH_OPACITY = 4 * 32   # bits of a texel
FOR_USD = "For USD"
CLEAR = {"BSDF_TRANSPARENT", "BSDF_REFRACTION", "BSDF_GLASS"}   # shaders that light goes through


def new_image(name: str, texels: np.ndarray, whole: AllOrNothing) -> Steps[bpy.types.Image]:
    """An image of linear light (height, width, 3), or with an opacity of its own (height, width, 4), packed into the
    file; a step before each of Blender's calls that take long."""
    packed = yield from part(core.in_steps(partial(open_exr, texels)), 0.0, 0.0, WRITING)
    image = bpy.data.images.new(name, 1, 1, alpha=texels.shape[2] == 4, float_buffer=True, is_data=True)
    whole.undo(remove_new, image)
    # light is not darker where less of it is seen
    image.alpha_mode = "CHANNEL_PACKED"
    image.pack(data=packed, data_len=len(packed))
    image.source = "FILE"
    yield 0.0, WRITING
    # it is read now, not where the window is drawn
    image.update()
    yield 0.0, WRITING
    return image


def new_material(name: str, image: bpy.types.Image, export_image: bpy.types.Image,
                 mirror: Sequence[bpy.types.Material | None], around: Surroundings, whole: AllOrNothing
                 ) -> bpy.types.Material:
    """Return a material that shows light as the materials of a `mirror` reflect it.

    Cycles and EEVEE show `image`, by the UV map `UV_MAP`, tinted and mixed as the mirror's own shader would at the true
    angle. Exporters find `export_image`, which has all of that in it, as unlit base colour. The last of
    four channels of `image` is opacity.

    Parameters
    ----------
    mirror : sequence of bpy.types.Material or None
        None shows all of the light.
    """
    material, shaders = _merged(name, mirror, whole)
    tree = material.node_tree
    own = [node for node in tree.nodes if node.label != FOR_USD]
    light = _look_up(tree, image)
    build = MirrorPart(tree, light.outputs["Color"], around)
    shown = build.surface(mirror, shaders, own)
    opacity = image.depth == WITH_OPACITY
    if opacity:
        shown = build.mixed(light.outputs["Alpha"], build.clear(), shown)
    output = one_output(tree)
    tree.links.new(shown, output.inputs["Surface"])
    for name_ in ("Displacement", "Volume"):
        for link in list(output.inputs[name_].links):
            tree.links.remove(link)
    if image.source != "SEQUENCE":
        show_unblurred(tree, [light], output, whole)
    before = build.before_the_mirror(shown, mirror)
    if opacity and around.behind:
        # a clear mirror shows its reflection itself
        before = build.mixed(build.calculated("GREATER_THAN", light.outputs["Alpha"], OPAQUE), build.clear(), shown)
    build.feed(before, build.add("ShaderNodeOutputMaterial", target="CYCLES").inputs["Surface"])
    if image.source == "SEQUENCE":
        # EEVEE's own look-up: the nodes above know the size of one picture alone
        build.feed(shown, build.add("ShaderNodeOutputMaterial", target="EEVEE").inputs["Surface"])
    _add_export(build, output, export_image, opacity or not all(map(is_opaque, mirror)))
    return material


def show_as_cut_out(material: bpy.types.Material) -> None:
    """Let glTF's exporter write that what a material of light shows is either clear or opaque."""
    build = ShaderBuilder(material.node_tree)
    for link in list(material.node_tree.nodes.active.outputs["Alpha"].links):
        # that of USD knows no such thing
        if link.to_node.type == "MIX_SHADER":
            build.feed(build.calculated("GREATER_THAN", link.from_socket, 0.5), link.to_socket)


def alone(material: bpy.types.Material) -> bpy.types.Material:
    """Return a copy of a material of light that shows in Cycles what EEVEE shows, and stops what goes through it: the
    opacity of the picture tells of that."""
    copy = material.copy()
    tree, build = copy.node_tree, ShaderBuilder(copy.node_tree)
    shown = tree.get_output_node("EEVEE").inputs["Surface"].links[0].from_socket
    build.feed(shown, tree.get_output_node("CYCLES").inputs["Surface"])
    for node in [node for node in tree.nodes if node.type in {*CLEAR, "BSDF_PRINCIPLED"}]:
        links, shader = list(node.outputs[0].links), node.outputs[0]
        colour = given(node.inputs["Color" if node.type in CLEAR else "Base Color"])
        left = sum(colour[:3]) / 3.0 if isinstance(colour, tuple) else colour
        stopped = build.mixed(left, build.glow(0.0), build.add("ShaderNodeHoldout").outputs[0])
        if node.type not in CLEAR:
            through = given(node.inputs["Transmission Weight"])
            cut(tree, node.inputs["Transmission Weight"], 0.0)
            stopped = build.mixed(through, shader, stopped)
        for link in links:
            build.feed(stopped, link.to_socket)
    return copy


def _add_export(build: ShaderBuilder, output: bpy.types.Node, image: bpy.types.Image, clear: bool) -> None:
    """Let the output for all other engines show an image in nodes that exporters read, with its opacity if `clear`.

    That of glTF makes an unlit material of a colour which is the surface itself; that of USD takes what it knows of
    the first Principled BSDF that it finds, be it connected or not.
    """
    tree = build.tree
    look = _look_up(tree, image)
    output.target = "ALL"
    shown = look.outputs["Color"]
    if clear:
        shown = build.mixed(look.outputs["Alpha"], build.add("ShaderNodeBsdfTransparent").outputs[0], shown)
    tree.links.new(shown, output.inputs["Surface"])
    output.is_active_output, tree.nodes.active = True, look
    for node in tree.nodes:
        node.select = node == look
    told = next(node for node in tree.nodes if node.label == FOR_USD)
    told.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    told.inputs["Roughness"].default_value = told.inputs["IOR"].default_value = 1.0
    told.inputs["Emission Strength"].default_value = 1.0
    tree.links.new(look.outputs["Color"], told.inputs["Emission Color"])
    if clear:
        tree.links.new(look.outputs["Alpha"], told.inputs["Alpha"])


def _put_first(tree: bpy.types.NodeTree) -> None:
    """Add the shader that USD's exporter is to find, before all others of its kinds."""
    others = [node for node in tree.nodes if node.type in {"BSDF_PRINCIPLED", "BSDF_DIFFUSE"}]
    tree.nodes.new("ShaderNodeBsdfPrincipled").label = FOR_USD
    for node in others:
        twin, name = copied([node], tree)[node], node.name
        for socket, new in zip(node.inputs, twin.inputs):
            for link in list(socket.links):
                tree.links.new(link.from_socket, new)
        for link in list(node.outputs[0].links):
            tree.links.new(twin.outputs[0], link.to_socket)
        # animation finds it by its name
        tree.nodes.remove(node)
        twin.name = name


def _look_up(tree: bpy.types.NodeTree, image: bpy.types.Image) -> bpy.types.Node:
    """Add nodes that look an image up by the UV map of light; discs have it as an attribute."""
    spot = tree.nodes.new("ShaderNodeAttribute")
    spot.attribute_name = UV_MAP
    look = tree.nodes.new("ShaderNodeTexImage")
    look.name, look.image, look.interpolation, look.extension = image.name, image, "Linear", "EXTEND"
    tree.links.new(spot.outputs["Vector"], look.inputs["Vector"])
    return look


def _merged(name: str, mirror: Sequence[bpy.types.Material | None], whole: AllOrNothing
            ) -> tuple[bpy.types.Material, list[bpy.types.Node | None]]:
    """Return a new material with the nodes of all materials that have some, and the shader of each, or None."""
    with_nodes = [one for one in mirror if one is not None and compat.uses_nodes(one)]
    material = with_nodes[0].copy() if with_nodes else bpy.data.materials.new(name)
    whole.undo(remove_new, material)
    material.name = name
    tree = compat.use_nodes(material)
    if not with_nodes:
        tree.nodes.clear()
        tree.nodes.new("ShaderNodeOutputMaterial")
    open_groups(tree)
    _put_first(tree)
    shader_of = {one: surface_shader(tree) for one in with_nodes[:1]} | copied_shaders(with_nodes[1:], tree)
    return material, [shader_of.get(one) for one in mirror]
