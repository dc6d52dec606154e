"""Blender's lamps, and meshes that emit, as places that light comes from, each with its share of the power.

In come objects; out come eyes that look where light goes, with their power in Cycles' units.
"""
from .area_lamps import is_sheared, rays_meet
from .eye import Eye
from .instanced_lamps import instancers_of_lamps
from .lamps import (
    GLINT,
    NO_LAMP,
    NoLight,
    chosen_lamps,
    eyes_of,
    is_glint,
    is_met,
    light_of_nodes,
    meant_lamps,
)
from .mesh_lamps import EMISSION, is_mesh_lamp, radiance_of

__all__ = ["EMISSION", "Eye", "GLINT", "NO_LAMP", "NoLight", "chosen_lamps", "eyes_of", "instancers_of_lamps",
           "is_glint", "is_mesh_lamp", "is_met", "is_sheared", "light_of_nodes", "meant_lamps", "radiance_of",
           "rays_meet"]
