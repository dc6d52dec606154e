"""The UV map by which a result shows light, and the images that it shows."""
import bpy
import numpy as np

UV_MAP = "Reflection Light"


def light_layer(mesh: bpy.types.Mesh) -> bpy.types.MeshUVLoopLayer:
    """The map of a mesh with faces; where there are as many as a mesh can hold the last gives way, which nothing of a
    lit result shows."""
    layer = mesh.uv_layers.get(UV_MAP) or mesh.uv_layers.new(name=UV_MAP, do_init=False)
    if layer is None:
        mesh.uv_layers.remove(mesh.uv_layers[len(mesh.uv_layers) - 1])
        layer = mesh.uv_layers.new(name=UV_MAP, do_init=False)
    return layer


def light_points(mesh: bpy.types.Mesh) -> bpy.types.Attribute:
    """The map of loose points, as an attribute that their discs have at their corners.

    It takes the place of the first map, which goes behind all others: Blender 5 lets discs show the map of that place.
    """
    known = mesh.attributes.get(UV_MAP)
    if known is not None:
        return known
    first = next((entry.name for entry in mesh.attributes if entry.data_type == "FLOAT2"), None)
    if first is None:
        return mesh.attributes.new(UV_MAP, "FLOAT2", "POINT")
    values = np.empty(2 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes[first].data.foreach_get("vector", values)
    mesh.attributes[first].name = UV_MAP
    mesh.attributes.new(first, "FLOAT2", "POINT").data.foreach_set("vector", values)
    return mesh.attributes[UV_MAP]


def images_of(material: bpy.types.Material) -> list[bpy.types.Image]:
    """Return the images that a material of light shows, the exact one first; fewer if somebody has changed the
    material.
    """
    nodes = material.node_tree.nodes if material.node_tree else ()
    # nodes of a mirror's own may show images of the user's
    return [node.image for node in nodes
            if node.type == "TEX_IMAGE" and node.image is not None and node.name.startswith(UV_MAP)]
