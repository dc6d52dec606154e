"""A result beside Cycles: rendered, measured, drawn, written down and shown."""
from .compare_images import comparison_pictures
from .compare_pictures import Renders, render_comparison
from .compare_report import write_report
from .pictures import Pictures, render_pictures
from .show_comparison import REFLECTION_PICTURES, load_pictures, remember, show_picture

__all__ = ["Pictures", "REFLECTION_PICTURES", "Renders", "comparison_pictures", "load_pictures", "remember",
           "render_comparison", "render_pictures", "show_picture", "write_report"]
