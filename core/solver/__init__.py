"""The cubic: at which times and where a three-ray camera sees a point.

In come the corners V_i and rays R_i of cameras and a point P each; out come all roots s > 0 of
P = sum W_i V_i + s sum W_i R_i with their weights W, and which pairs rounding leaves in doubt. C. Mei, V. Popescu,
E. Sacks, GRAPP 2007.
"""
from .projection import Images, project

__all__ = ["Images", "project"]
