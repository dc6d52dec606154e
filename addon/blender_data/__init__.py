"""Blender's data as arrays, and arrays as Blender's data: roles, meshes, view, results, records."""
from .disc_nodes import disc_nodes, forget_nodes
from .join_meshes import DiffuseScene, read_mirror, read_scene
from .mirror_materials import is_mirror
from .read_meshes import SURFACES
from .read_view import read_view, render_size
from .roles import Participants, choose, participants, results_of
from .write_mesh import mesh_arrays, write_mesh
from .write_object import RAYS, origin_of, show_to_camera, write_object
from .write_points import point_arrays

__all__ = ["DiffuseScene", "Participants", "RAYS", "SURFACES", "choose", "disc_nodes", "forget_nodes", "is_mirror",
           "mesh_arrays", "origin_of", "participants", "point_arrays", "read_mirror", "read_scene", "read_view",
           "render_size", "results_of", "show_to_camera", "write_mesh", "write_object"]
