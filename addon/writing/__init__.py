"""Arrays as Blender's data: meshes, points, the objects that carry them, windows, and records of the making."""
from .disc_nodes import disc_nodes, forget_nodes, hide_discs
from .light_layer import UV_MAP, light_layer
from .mesh_arrays import MOST_UV_MAPS, Attribute, MeshArrays, mesh_arrays, shown_layers
from .node_builder import Builder
from .point_arrays import point_arrays
from .records import LONGEST as LONGEST_RECORD
from .result_size import mesh_bytes, size_text
from .windows import close_abandoned_windows, close_window, open_window, what_is_in_the_way
from .write_mesh import write_mesh
from .write_object import RAYS, Reflection, new_beside, new_object, show_own_materials, write_object

__all__ = ["Attribute", "Builder", "LONGEST_RECORD", "MOST_UV_MAPS", "MeshArrays", "RAYS", "Reflection",
           "UV_MAP", "close_abandoned_windows", "close_window", "disc_nodes", "forget_nodes", "hide_discs",
           "light_layer", "mesh_arrays", "mesh_bytes", "new_beside", "new_object", "open_window", "point_arrays",
           "show_own_materials", "shown_layers", "size_text", "what_is_in_the_way", "write_mesh", "write_object"]
