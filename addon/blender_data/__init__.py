"""Blender's data as arrays, and arrays as Blender's data: roles, meshes, view, results, records."""
from .disc_nodes import disc_nodes, forget_nodes, hide_discs
from .join_meshes import DiffuseScene, MirrorSurface, read_mirror, read_scene
from .light_layer import UV_MAP, light_layer
from .mesh_arrays import MOST_UV_MAPS, Attribute, MeshArrays, mesh_arrays, shown_layers
from .mirror_materials import is_mirror
from .node_builder import Builder
from .opaque_materials import is_opaque
from .point_arrays import point_arrays
from .read_meshes import SURFACES
from .read_view import read_view, render_size
from .records import LONGEST as LONGEST_RECORD
from .roles import NothingSeen, Participants, candidates, choose, participants, results_of, visible
from .windows import close_abandoned_windows, close_window, open_window, what_is_in_the_way
from .write_mesh import write_mesh
from .write_object import RAYS, Reflection, new_beside, new_object, show_own_materials, write_object

__all__ = ["Attribute", "Builder", "DiffuseScene", "LONGEST_RECORD", "MOST_UV_MAPS", "MeshArrays", "MirrorSurface",
           "NothingSeen", "Participants", "RAYS", "Reflection", "SURFACES", "UV_MAP", "candidates", "choose",
           "close_abandoned_windows", "close_window", "disc_nodes", "forget_nodes", "hide_discs", "is_mirror",
           "is_opaque", "light_layer", "mesh_arrays", "new_beside", "new_object", "open_window", "participants",
           "point_arrays", "read_mirror", "read_scene", "read_view", "render_size", "results_of",
           "show_own_materials", "shown_layers", "visible", "what_is_in_the_way", "write_mesh", "write_object"]
