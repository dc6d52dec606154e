"""Meshes with their layers and lines, read once, and joined to one scene in world space."""
from .join_meshes import DiffuseScene, MirrorSurface, join_mirror, join_scene, read_mirror, read_mirrors, read_scene
from .point_vectors import vectors
from .read_meshes import LocalMesh, Placed, drawn_meshes, is_rendered, read_meshes

__all__ = ["DiffuseScene", "LocalMesh", "MirrorSurface", "Placed", "drawn_meshes", "is_rendered",
           "join_mirror", "join_scene", "read_meshes", "read_mirror", "read_mirrors", "read_scene", "vectors"]
