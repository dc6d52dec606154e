"""Trees of nodes, built node by node: of shaders, and of geometry that draws discs."""
from .disc_nodes import disc_nodes, forget_nodes, hide_discs, show_discs
from .node_builder import Builder
from .unblurred_image import forget_unblurred, show_unblurred, unblurred_in

__all__ = ["Builder", "disc_nodes", "forget_nodes", "forget_unblurred", "hide_discs", "show_discs", "show_unblurred",
           "unblurred_in"]
