"""Preparation of results for line drawing: neighbouring faces that show one continuous surface share vertices.

Input is a reflection mesh. Output is a mesh with the same picture, whose vertices are shared along every side except
outlines.
"""
from .closed_borders import with_borders_closed

__all__ = ["with_borders_closed"]
