"""Rays one by one: cones round clusters of them, pyramids of rays, light by rays."""
from .cluster_cones import cones_around
from .light_rays import Landed, LightRays, by_boxes
from .planes import plane_distance
from .ray_pyramid import RayPyramid

__all__ = ["Landed", "LightRays", "RayPyramid", "by_boxes", "cones_around", "plane_distance"]
