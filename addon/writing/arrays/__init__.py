"""Arrays in Blender's own types that are written into meshes: faces, points, edges and layers, and their sizes."""
from .attribute import Attribute
from .later_mirrors import ARRIVAL, LATER_COSINE, LATER_MATERIAL, NORMAL
from .light_layer import UV_MAP, images_of, light_layer, light_points
from .mesh_arrays import (
    MOST_UV_MAPS,
    Lines,
    MeshArrays,
    in_order,
    mesh_arrays,
    shown_layers,
    vertices_written,
)
from .mesh_edges import Edges
from .point_arrays import DISC_SCALE, point_arrays
from .result_size import mesh_bytes, size_text
from .shown_attributes import OF_METHOD

__all__ = ["ARRIVAL", "Attribute", "DISC_SCALE", "Edges", "LATER_COSINE", "LATER_MATERIAL", "Lines", "MOST_UV_MAPS",
           "MeshArrays", "NORMAL", "OF_METHOD", "UV_MAP", "images_of", "in_order", "light_layer", "light_points",
           "mesh_arrays", "mesh_bytes", "point_arrays", "shown_layers", "size_text", "vertices_written"]
