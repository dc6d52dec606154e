"""Points: every image of every vertex as a disc, the part that the talk left in process."""
from .reflected_points import reflected_points

__all__ = ["reflected_points"]
