"""Results of which lines are drawn: faces that lie side by side and show one surface going on share vertices.

In comes a reflection mesh; out comes the same picture on vertices that are shared along every side but outlines.
"""
from .closed_borders import with_borders_closed

__all__ = ["with_borders_closed"]
