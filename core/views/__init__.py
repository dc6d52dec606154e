"""Views: of a camera and of a lamp, and what is drawn in them.

In come places; out come pixels, depths and rays, and pictures of triangles: which is nearest, and what is covered. A
lamp sees in all directions, in a picture of directions.
"""
from .coverage import Covered, box, planes
from .lamp_view import LampView, in_cone
from .pages import pages_of
from .view import View
from .z_buffer import draw

__all__ = ["Covered", "LampView", "View", "box", "draw", "in_cone", "pages_of", "planes"]
