"""The largest part of a mirror in which a point has one image at the most, and the way of points to these images.

In come cameras and points; out come the mirror's triangles, places on them and distances.
"""
from .patch import Patch, speck
from .patch_nodes import Descent, Walk
from .walk import changes, find

__all__ = ["Descent", "Patch", "Walk", "changes", "find", "speck"]
