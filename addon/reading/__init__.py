"""Blender's data as arrays: who takes part, meshes with their layers, materials, the view."""
from .join_meshes import DiffuseScene, MirrorSurface, read_mirror, read_scene
from .mirror_materials import is_mirror
from .opaque_materials import is_opaque
from .read_meshes import SURFACES
from .read_view import NO_CAMERA, read_view, render_size
from .roles import (
           NO_MIRROR,
           NothingSeen,
           Participants,
           can_take_part,
           candidates,
           choose,
           participants,
           results_of,
           visible,
)

__all__ = ["DiffuseScene", "MirrorSurface", "NO_CAMERA", "NO_MIRROR", "NothingSeen", "Participants", "SURFACES",
           "can_take_part", "candidates", "choose", "is_mirror", "is_opaque", "participants", "read_mirror",
           "read_scene", "read_view", "render_size", "results_of", "visible"]
