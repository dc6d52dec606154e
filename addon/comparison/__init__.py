"""A result beside Cycles: rendered, measured, drawn, written down and shown."""
from .compare_images import comparison_pictures
from .compare_pictures import pictures, render_comparison
from .compare_report import write_report
from .show_comparison import load_pictures, remember, show_picture

__all__ = ["comparison_pictures", "load_pictures", "pictures", "remember", "render_comparison", "show_picture",
           "write_report"]
