"""Meshes with their layers and lines, read once, and joined to one scene in world space."""
from .hidden_instances import is_rendered
from .instance_answers import questions
from .join_meshes import DiffuseScene, MirrorSurface, join_mirror, join_scene, read_mirror, read_mirrors, read_scene
from .mesh_values import corner_vertices, numbers, vectors
from .read_meshes import LocalMesh, Placed, drawn_meshes, read_meshes, takes_part

__all__ = ["DiffuseScene", "LocalMesh", "MirrorSurface", "Placed", "corner_vertices", "drawn_meshes", "is_rendered",
           "join_mirror", "join_scene", "numbers", "questions", "read_meshes", "read_mirror", "read_mirrors",
           "read_scene", "takes_part", "vectors"]
