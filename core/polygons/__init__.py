"""The reflection as polygons: images of vertices, clipping, exact corners, triangulation, caustics, refinement.

In come candidates; out come faces on shared nodes, each seen exactly there and straying inside by less than the
tolerance. I. E. Sutherland, G. W. Hodgman, CACM 1974; kinds of corners: S. Vallance, P. Calder, ACSC 2006.
"""
from .caustics import split_at_caustics
from .clipping import CONTACT, HIDDEN, SCENE_EDGE, Polygons, clip, cut, whole_triangles
from .convex_parts import SMALLEST, ConvexParts, Lines, divide
from .face_refinement import FaceRefinement
from .outline_refinement import refine_for_outlines
from .polygon_corners import Nodes, polygon_nodes
from .triangulation import Faces, connect
from .vertex_images import VertexImages, images_of_pairs, repeated, vertex_images

__all__ = ["CONTACT", "ConvexParts", "FaceRefinement", "Faces", "HIDDEN", "Lines", "Nodes", "Polygons", "SCENE_EDGE",
           "SMALLEST", "VertexImages", "clip", "connect", "cut", "divide", "images_of_pairs", "polygon_nodes",
           "refine_for_outlines", "repeated", "split_at_caustics", "vertex_images", "whole_triangles"]
