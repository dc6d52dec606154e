"""Backward: the part of a mirror whose triangles are too small for cameras of their own, by one ray for each pixel.

In come a view, a mirror and what rays may meet; out come faces between what neighbouring rays show. C. Mei, talk, 2006:
hybrid forward-backward.
"""
from .arrays import backward_arrays
from .backward_part import BackwardPart

__all__ = ["BackwardPart", "backward_arrays"]
