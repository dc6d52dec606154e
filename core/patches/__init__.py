"""The patch, the largest part of a mirror in which a point has at most one image, and the search for these images.

Input are cameras and points. Output are for each image the mirror's triangle, the place on it and the distance.
"""
from .patch import Patch, speck
from .patch_nodes import Descent, Walk
from .walk import changes, find

__all__ = ["Descent", "Patch", "Walk", "changes", "find", "speck"]
