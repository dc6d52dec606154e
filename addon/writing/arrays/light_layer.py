"""The UV map by which a result shows light."""
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
