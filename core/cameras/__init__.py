"""General three-ray cameras on the mirror, and the true reflection map from places on it to reflected rays.

Input are a view and a mirror. Output are cameras whose interpolated rays deviate from the true ones by less than the
tolerance. C. Mei, V. Popescu, E. Sacks, GRAPP 2007; rays are kept above the flat surface as in Cycles.
"""
from .bounced_map import BouncedMap
from .camera_splitting import in_picture, ray_numbers, split_cameras, true_rays, with_pieces
from .folding import may_fold
from .mirror_map import MirrorMap
from .mirror_refinement import refine_mirror
from .mirror_surface import ALONG_UV, MirrorSurface, drawn_in, least_weight
from .picture_areas import (
    covered_pixels,
    picture_areas,
    pixels_around_faces,
    pixels_crossed,
    pixels_held,
    pixels_of,
    places_at,
)
from .picture_cells import PictureCells, box_counts, cells_before, cells_between
from .reflection_map import ReflectionMap, grown
from .shading_horizon import beyond_horizon, cut_at_horizon
from .three_ray_cameras import Cameras, not_edge_on, three_ray_cameras, visible_triangles
from .triangle_walk import INSIDE, brought_back, distance_from, settle

__all__ = ["ALONG_UV", "BouncedMap", "Cameras", "INSIDE", "MirrorMap", "MirrorSurface", "PictureCells", "ReflectionMap",
           "beyond_horizon", "box_counts", "brought_back", "cells_before", "cells_between", "covered_pixels",
           "cut_at_horizon", "distance_from", "drawn_in", "grown", "in_picture", "least_weight", "may_fold",
           "not_edge_on", "picture_areas", "pixels_around_faces", "pixels_crossed", "pixels_held", "pixels_of",
           "places_at", "ray_numbers", "refine_mirror", "settle", "split_cameras", "three_ray_cameras", "true_rays",
           "visible_triangles", "with_pieces"]
