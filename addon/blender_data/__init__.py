"""Blender's data as arrays, and arrays as Blender's data: roles, meshes, view, results, records."""
from .disc_nodes import disc_nodes, forget_nodes
from .join_meshes import DiffuseScene, MirrorSurface, read_mirror, read_normals, read_scene
from .mesh_arrays import MOST_UV_MAPS, Attribute, MeshArrays, mesh_arrays, shown_layers
from .mirror_materials import is_mirror
from .opaque_materials import is_opaque
from .point_arrays import point_arrays
from .read_meshes import SURFACES
from .read_view import read_view, render_size
from .records import LONGEST as LONGEST_RECORD
from .roles import Participants, choose, participants, results_of
from .windows import close_abandoned_windows, what_is_in_the_way
from .write_mesh import write_mesh
from .write_object import RAYS, Reflection, show_own_materials, write_object

__all__ = ["Attribute", "DiffuseScene", "LONGEST_RECORD", "MOST_UV_MAPS", "MeshArrays", "MirrorSurface", "Participants",
           "RAYS", "Reflection", "SURFACES", "choose", "close_abandoned_windows", "disc_nodes", "forget_nodes",
           "is_mirror", "is_opaque", "mesh_arrays", "participants", "point_arrays", "read_mirror", "read_normals",
           "read_scene", "read_view", "render_size", "results_of", "show_own_materials", "shown_layers",
           "what_is_in_the_way", "write_mesh", "write_object"]
