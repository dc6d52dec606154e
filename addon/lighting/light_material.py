"""The material that shows a picture of light where the camera saw it, and the image that it shows."""
from __future__ import annotations

import bpy
import numpy as np

from ..blender_data import compat

POSITION = "picture_position"


def new_image(name: str, texels: np.ndarray) -> bpy.types.Image:
    """An image of linear light (height, width, 3), or with an opacity of its own (height, width, 4), packed into the
    file."""
    height, width, channels = texels.shape
    image = bpy.data.images.new(name, width, height, float_buffer=True, is_data=True, alpha=channels == 4)
    # light is not darker where less of it is seen
    image.alpha_mode = "CHANNEL_PACKED"
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :channels] = texels
    image.pixels.foreach_set(rgba.ravel())
    image.pack()
    return image


def new_material(name: str, image: bpy.types.Image, texels: np.ndarray) -> bpy.types.Material:
    """A material that emits the image at `POSITION`, homogeneous coordinates in it, which are linear on a face where
    places in a picture are not."""
    material = bpy.data.materials.new(name)
    tree = compat.use_nodes(material)
    tree.nodes.clear()

    def add(kind: str, **settings) -> bpy.types.Node:
        node = tree.nodes.new(kind)
        node.location = (200.0 * len(tree.nodes), 0.0)
        for key, value in settings.items():
            setattr(node, key, value)
        return node
    place = add("ShaderNodeAttribute", attribute_name=POSITION)
    split = add("ShaderNodeSeparateXYZ")
    across, up = (add("ShaderNodeMath", operation="DIVIDE") for _ in range(2))
    spot = add("ShaderNodeCombineXYZ")
    look = add("ShaderNodeTexImage", image=image, interpolation="Linear", extension="EXTEND")
    glow = add("ShaderNodeEmission")
    output = add("ShaderNodeOutputMaterial")
    join = tree.links.new
    join(place.outputs["Vector"], split.inputs[0])
    for axis, divided in enumerate((across, up)):
        join(split.outputs[axis], divided.inputs[0])
        join(split.outputs[2], divided.inputs[1])
        join(divided.outputs[0], spot.inputs[axis])
    join(spot.outputs[0], look.inputs["Vector"])
    join(look.outputs["Color"], glow.inputs["Color"])
    join(glow.outputs[0], output.inputs["Surface"])
    # what solid view shows, by texture or by one colour
    tree.nodes.active = look
    shown = texels[(texels > 0.0).any(axis=2)]
    if len(shown):
        material.diffuse_color = (*np.minimum(shown, 1.0).mean(axis=0), 1.0)
    return material


def image_of(material: bpy.types.Material) -> bpy.types.Image | None:
    """The image that a material of light shows; None where somebody has changed that."""
    nodes = material.node_tree.nodes if material.node_tree else ()
    return next((node.image for node in nodes if node.type == "TEX_IMAGE"), None)
