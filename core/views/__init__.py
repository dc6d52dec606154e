"""Views: of a camera and of a lamp, and what is drawn in them."""
from .lamp_view import LampView, in_cone
from .view import View
from .z_buffer import draw

__all__ = ["LampView", "View", "draw", "in_cone"]
