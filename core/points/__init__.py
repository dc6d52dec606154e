"""Points: every image of every vertex as a disc, the part that the talk calls work in progress.

Input are a view, a mirror, and vertices or triangles with points all over them. Output are discs at the images, as
large as the image of the surface that each represents. C. Mei, talk, 2006.
"""
from .reflected_points import reflected_points

__all__ = ["reflected_points"]
