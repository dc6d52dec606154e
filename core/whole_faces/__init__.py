"""Vertices first: triangles that a smooth part of the mirror shows whole are drawn from the images of their vertices.

In come cameras and the diffuse scene; out come faces, and the pieces of triangles that are left for the cameras: over
outlines, folds and creases, and where layers lie too close.
"""
from .seams import Seamed, seamed
from .whole import WholeFaces, whole_faces

__all__ = ["Seamed", "WholeFaces", "seamed", "whole_faces"]
