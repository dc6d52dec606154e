"""Blender's data as arrays: who takes part, meshes with their layers, materials, the view."""
from .join_meshes import DiffuseScene, MirrorSurface, read_mirror, read_scene
from .mirror_materials import is_mirror
from .opaque_materials import is_opaque
from .read_meshes import SURFACES
from .read_view import NO_CAMERA, read_view, render_size
from .results import camera_of, every_result_of, results_of
from .roles import (
    NO_MIRROR,
    NothingSeen,
    Participants,
    can_take_part,
    candidates,
    choose,
    participants,
    rendered_collections,
    seen_in,
    visible,
)

__all__ = ["DiffuseScene", "MirrorSurface", "NO_CAMERA", "NO_MIRROR", "NothingSeen", "Participants", "SURFACES",
           "camera_of", "can_take_part", "candidates", "choose", "every_result_of", "is_mirror", "is_opaque",
           "participants", "read_mirror", "read_scene", "read_view", "rendered_collections", "render_size",
           "results_of", "seen_in", "visible"]
