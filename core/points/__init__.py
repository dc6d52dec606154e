"""Points: every image of every vertex as a disc, the part that the talk left in process.

In come a view, a mirror and vertices, or triangles with points all over them; out come discs at the images, as large
as the picture of what each stands for. C. Mei, talk, 2006.
"""
from .reflected_points import reflected_points

__all__ = ["reflected_points"]
