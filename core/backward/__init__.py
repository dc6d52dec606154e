"""Backward: the part of a mirror whose triangles are too small for one camera each, sampled by one ray per pixel.

Input are a view, a mirror and the triangles that rays may hit. Output are faces between the hit points of neighbouring
rays. C. Mei, talk, 2006: hybrid forward-backward.
"""
from .arrays import backward_arrays
from .backward_part import BackwardPart

__all__ = ["BackwardPart", "backward_arrays"]
