"""The UV map by which a result shows light, and the images that it shows."""
import bpy

UV_MAP = "Reflection Light"


def light_layer(mesh: bpy.types.Mesh) -> bpy.types.MeshUVLoopLayer:
    """The map of a mesh with faces; where there are as many as a mesh can hold the last gives way, which nothing of a
    lit result shows."""
    layer = mesh.uv_layers.get(UV_MAP) or mesh.uv_layers.new(name=UV_MAP, do_init=False)
    if layer is None:
        mesh.uv_layers.remove(mesh.uv_layers[len(mesh.uv_layers) - 1])
        layer = mesh.uv_layers.new(name=UV_MAP, do_init=False)
    return layer


def images_of(material: bpy.types.Material) -> list[bpy.types.Image]:
    """The images that a material of light shows, the exact one first; fewer where somebody has changed that."""
    nodes = material.node_tree.nodes if material.node_tree else ()
    # nodes of a mirror's own may show images of the user's
    return [node.image for node in nodes
            if node.type == "TEX_IMAGE" and node.image is not None and node.name.startswith(UV_MAP)]
