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
from ..reading.materials import one_output, surface_shader
from ..writing import UV_MAP, show_unblurred
from ..writing.nodes.opened_groups import open_groups

WRITING = "Writing"


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
    angle. Exporters find `export_image`, which has all of that in it, as unlit base colour.

    Parameters
    ----------
    mirror : sequence of bpy.types.Material or None
        None shows all of the light.
    """
    material, shaders = _merged(name, mirror, whole)
    tree = material.node_tree
    own = list(tree.nodes)
    light = _look_up(tree, image)
    build = MirrorPart(tree, light.outputs["Color"], around)
    shown = build.surface(mirror, shaders, own)
    output = one_output(tree)
    tree.links.new(shown, output.inputs["Surface"])
    for name_ in ("Displacement", "Volume"):
        for link in list(output.inputs[name_].links):
            tree.links.remove(link)
    if image.source != "SEQUENCE":
        show_unblurred(tree, [light], output, whole)
    build.feed(build.before_the_mirror(shown, mirror), build.add("ShaderNodeOutputMaterial", target="CYCLES").inputs[
        "Surface"])
    if image.source == "SEQUENCE":
        # EEVEE's own look-up: the nodes above know the size of one picture alone
        build.feed(shown, build.add("ShaderNodeOutputMaterial", target="EEVEE").inputs["Surface"])
    _add_export(tree, output, export_image)
    return material


def _add_export(tree: bpy.types.NodeTree, output: bpy.types.Node, image: bpy.types.Image) -> None:
    """Let the output for all other engines show an image in nodes that exporters read.

    That of glTF makes an unlit material of a colour which is the surface itself; that of USD takes what it knows of
    the first Principled BSDF that it finds, be it connected or not.
    """
    look = _look_up(tree, image)
    output.target = "ALL"
    tree.links.new(look.outputs["Color"], output.inputs["Surface"])
    output.is_active_output, tree.nodes.active = True, look
    for node in tree.nodes:
        node.select = node == look
    told = tree.nodes.new("ShaderNodeBsdfPrincipled")
    told.label = "For USD"
    told.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    told.inputs["Roughness"].default_value = told.inputs["IOR"].default_value = 1.0
    told.inputs["Emission Strength"].default_value = 1.0
    tree.links.new(look.outputs["Color"], told.inputs["Emission Color"])


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
    shader_of = {one: surface_shader(tree) for one in with_nodes[:1]} | copied_shaders(with_nodes[1:], tree)
    return material, [shader_of.get(one) for one in mirror]
