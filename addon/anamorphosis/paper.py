"""White paper with a picture on it, where the map of a mirror says."""
from __future__ import annotations

import os
from collections.abc import Iterator

import bpy

from ...core import ReflectionError
from .. import compat
from ..faults import AllOrNothing
from ..reading import all_nodes
from ..reading.materials import feeding, shown_output
from .sheet_arrays import UV_MAP

WHITE = (0.8, 0.8, 0.8, 1.0)    # albedo of white paper


def load_picture(name: str, whole: AllOrNothing) -> bpy.types.Image:
    """Return the image with that name in the open file, or the one at that path, which is loaded if necessary.

    Raises
    ------
    ReflectionError
        Where there is no picture.
    """
    image = bpy.data.images.get(name)
    if image is None:
        path = os.path.abspath(bpy.path.abspath(name))
        if not os.path.isfile(path):
            raise ReflectionError(f"There is no picture '{name}': choose an image file.")
        before = set(bpy.data.images)
        image = bpy.data.images.load(path, check_existing=True)
        if image not in before:
            whole.undo(bpy.data.images.remove, image)
    if not (image.size[0] and image.size[1]):
        raise ReflectionError(f"'{name}' is no picture that Blender can read: choose an image file.")
    return image


def paper_with(image: bpy.types.Image, whole: AllOrNothing) -> bpy.types.Material:
    """Return a material that shows an image within its borders and is white outside and where the image is transparent.
    """
    material = bpy.data.materials.new("Mirror Picture")
    whole.undo(bpy.data.materials.remove, material)
    tree = compat.use_nodes(material)
    tree.nodes.clear()
    place, look, mixed, shader, output = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in
        ("UVMap", "TexImage", "Mix", "BsdfPrincipled", "OutputMaterial"))
    for column, node in enumerate((place, look, mixed, shader, output)):
        node.location = (280.0 * (column - 2), 0.0)
    place.uv_map = UV_MAP
    look.image, look.extension = image, "CLIP"
    mixed.data_type = "RGBA"
    white, ink = (socket for socket in mixed.inputs if socket.type == "RGBA")
    white.default_value = WHITE
    shader.inputs["Roughness"].default_value, shader.inputs["Specular IOR Level"].default_value = 1.0, 0.0
    link = tree.links.new
    link(place.outputs["UV"], look.inputs["Vector"])
    link(look.outputs["Alpha"], mixed.inputs[0])
    link(look.outputs["Color"], ink)
    link(next(socket for socket in mixed.outputs if socket.type == "RGBA"), shader.inputs["Base Color"])
    link(shader.outputs["BSDF"], output.inputs["Surface"])
    tree.nodes.active = look    # active node: shown by solid view and used by texture painting
    return material


def picture_of(obj: bpy.types.Object) -> bpy.types.Image | None:
    """Return the picture that an object's materials show with the map of its mirror; None if they do not."""
    trees = [slot.material.node_tree for slot in obj.material_slots
             if slot.material is not None and compat.uses_nodes(slot.material)]
    rendered = next((layer.name for layer in obj.data.uv_layers if layer.active_render), "")
    return next((node.image for tree in trees for node in _shown(tree)
                 if node.type == "TEX_IMAGE" and not node.mute and node.image is not None
                 and _map_of(node, rendered) == UV_MAP), None)


def _shown(tree: bpy.types.NodeTree) -> Iterator[bpy.types.Node]:
    """Yield the nodes that determine what a material shows."""
    output = shown_output(tree)
    for node in feeding(output) if output is not None else ():
        yield node
        if node.type == "GROUP":
            yield from all_nodes(node.node_tree)


def _map_of(node: bpy.types.Node, rendered: str) -> str:
    """Return the name of the UV map that an image uses unchanged; "" if there is none. `rendered` is the map of
    renders.
    """
    socket = node.inputs["Vector"]
    while socket.is_linked and socket.links[0].from_node.type == "REROUTE":
        socket = socket.links[0].from_node.inputs[0]
    if not socket.is_linked:
        return rendered
    source = socket.links[0].from_node
    if source.type == "UVMAP":
        return source.uv_map or rendered
    if source.type == "ATTRIBUTE":
        return source.attribute_name
    return rendered if source.type == "TEX_COORD" and socket.links[0].from_socket.name == "UV" else ""
