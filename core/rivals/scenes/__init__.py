"""Scenes made from formulas, of any number of vertices and any fineness."""
from .made_scenes import MadeScene, talk_setting, with_mirror_triangles, with_vertices
from .shapes import combine, icosphere, sheet, torus
from .tessellation import quartered, tessellated

__all__ = ["MadeScene", "combine", "icosphere", "quartered", "sheet", "talk_setting", "tessellated", "torus",
           "with_mirror_triangles", "with_vertices"]
