"""Results of which lines are drawn: faces that lie side by side and show one surface going on share vertices."""
from .closed_borders import with_borders_closed

__all__ = ["with_borders_closed"]
