"""The reflection as polygons: images of vertices, clipping, exact corners, triangulation, caustics, refinement.

In come candidates; out come faces on shared nodes, each seen exactly there and straying inside by less than the
tolerance. I. E. Sutherland, G. W. Hodgman, CACM 1974; kinds of corners: S. Vallance, P. Calder, ACSC 2006.
"""
from .caustics import split_at_caustics
from .clipping import Polygons, clip, whole_triangles
from .convex_polygons import SMALLEST, ConvexPolygons, Line, scene_edges
from .covering import Overlaps
from .division import Lines, divide
from .face_refinement import FaceRefinement
from .outline_refinement import refine_for_outlines
from .polygon_corners import Nodes, polygon_nodes
from .triangulation import Faces, connect
from .vertex_images import VertexImages, images_of_pairs, repeated, vertex_images

__all__ = ["ConvexPolygons", "FaceRefinement", "Faces", "Line", "Lines", "Nodes", "Overlaps", "Polygons",
           "SMALLEST", "VertexImages", "clip", "connect", "divide", "images_of_pairs", "polygon_nodes",
           "refine_for_outlines", "repeated", "scene_edges", "split_at_caustics", "vertex_images", "whole_triangles"]
