"""The material that shows a picture of light where the camera saw it, and the images that it shows."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial

import bpy
import numpy as np

from ... import core
from .. import compat
from ..faults import AllOrNothing, Steps, part, remove_new
from ..files import open_exr
from ..writing import UV_MAP, images_of, show_unblurred
from .picture import SHINING

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


def new_export_image(name: str, texels: np.ndarray, whole: AllOrNothing) -> Steps[bpy.types.Image]:
    """The same for files that know no more than eight bits: sRGB, and nothing brighter than white."""
    yield 0.0, WRITING
    light = np.clip(texels, 0.0, 1.0)
    # IEC 61966-2-1
    shown = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0.0031308)**(1.0 / 2.4) - 0.055)
    yield 0.0, WRITING
    height, width, channels = shown.shape
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :channels] = shown
    image = bpy.data.images.new(name, width, height, alpha=channels == 4)
    whole.undo(remove_new, image)
    image.alpha_mode = "CHANNEL_PACKED"
    yield 0.0, WRITING
    image.pixels.foreach_set(rgba.ravel())
    yield 0.0, WRITING
    image.pack()
    yield 0.0, WRITING
    return image


def new_material(name: str, image: bpy.types.Image, export_image: bpy.types.Image, texels: np.ndarray,
                 whole: AllOrNothing, apart: tuple[bpy.types.Image, bpy.types.Image] | None = None
                 ) -> bpy.types.Material:
    """A material that emits an image where the map `UV_MAP` says: Cycles and EEVEE show `image`, or what of it is
    matte and what shines from two images `apart`, what follows the output for all engines shows `export_image`, in
    nodes that exporters read. EEVEE shows a still by `show_unblurred`, and an animated picture, whose size changes, by
    its own look-up.

    That of glTF makes an unlit material of a colour which is the surface itself; that of USD takes what it knows of
    the first Principled BSDF that it finds, be it connected or not.
    """
    material = bpy.data.materials.new(name)
    whole.undo(remove_new, material)
    tree = compat.use_nodes(material)
    tree.nodes.clear()

    def add(kind: str, place: tuple[float, float], **settings) -> bpy.types.Node:
        node = tree.nodes.new(kind)
        node.location = place
        for key, value in settings.items():
            setattr(node, key, value)
        return node
    spot = add("ShaderNodeAttribute", (-600.0, 0.0), attribute_name=UV_MAP)
    for shown, row, engines in ((image, 200.0, ("CYCLES", "EEVEE")), (export_image, -200.0, ("ALL",))):
        look = add("ShaderNodeTexImage", (-350.0, row), name=shown.name, image=shown, interpolation="Linear",
                   extension="EXTEND")
        tree.links.new(spot.outputs["Vector"], look.inputs["Vector"])
        for column, engine in enumerate(engines):
            output = add("ShaderNodeOutputMaterial", (200.0 * column, row), target=engine)
            tree.links.new(look.outputs["Color"], output.inputs["Surface"])
    if apart is not None:
        _put_apart(tree, add, spot, apart)
    if image.source != "SEQUENCE":
        exact = [node for node in tree.nodes if node.type == "TEX_IMAGE" and node != look]
        show_unblurred(tree, exact, tree.get_output_node("CYCLES"), whole)
    # the last of both: what exporters begin at, and what solid view shows by texture
    output.is_active_output, tree.nodes.active = True, look
    told = add("ShaderNodeBsdfPrincipled", (200.0, -200.0), label="For USD")
    told.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    told.inputs["Roughness"].default_value = told.inputs["IOR"].default_value = 1.0
    told.inputs["Emission Strength"].default_value = 1.0
    tree.links.new(look.outputs["Color"], told.inputs["Emission Color"])
    # what solid view shows by material
    seen = texels[(texels > 0.0).any(axis=2)]
    if len(seen):
        material.diffuse_color = (*np.minimum(seen, 1.0).mean(axis=0), 1.0)
    return material


def _put_apart(tree: bpy.types.NodeTree, add: Callable[..., bpy.types.Node], spot: bpy.types.Node,
               apart: tuple[bpy.types.Image, bpy.types.Image]) -> None:
    """Let Cycles and EEVEE show the first of two images, and the second on the faces that show what shines."""
    where = add("ShaderNodeAttribute", (-350.0, 1000.0), attribute_name=SHINING)
    both = add("ShaderNodeMix", (0.0, 500.0), data_type="RGBA")
    # its sockets for numbers, vectors and colours bear the same names
    tree.links.new(where.outputs["Fac"], both.inputs[0])
    for image, row, socket in zip(apart, (500.0, 750.0), both.inputs[6:8]):
        look = add("ShaderNodeTexImage", (-350.0, row), name=image.name, image=image, interpolation="Linear",
                   extension="EXTEND")
        tree.links.new(spot.outputs["Vector"], look.inputs["Vector"])
        tree.links.new(look.outputs["Color"], socket)
    for output in [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL" and node.target != "ALL"]:
        tree.links.new(both.outputs[2], output.inputs["Surface"])


def texels_shown(material: bpy.types.Material) -> np.ndarray | None:
    """What a material of light shows, (height, width, 3) float32; None where somebody has changed that."""
    image = next(iter(images_of(material)), None)
    if image is None or image.channels < 3 or not all(image.size):
        return None
    width, height = image.size
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, -1)[..., :3]
