"""Rays one by one: boxes round triangles, rays and cones through them, pyramids of rays, light by rays."""
from .box_tree import BoxTree
from .cluster_cones import cones_around
from .light_rays import Landed, LightRays, by_boxes
from .ray_pyramid import RayPyramid
from .tree_rays import first_hits, meet, plane_distance

__all__ = ["BoxTree", "Landed", "LightRays", "RayPyramid", "by_boxes", "cones_around", "first_hits", "meet",
           "plane_distance"]
