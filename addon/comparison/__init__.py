"""A result beside Cycles: rendered, measured, drawn, written down and shown."""
from .compare_images import comparison_pictures
from .compare_pictures import Renders, render_comparison
from .compare_report import write_report
from .light_of_results import Lit, Surroundings, against_rays
from .light_page import FILES as LIGHT_PICTURES
from .light_page import MESH, OWN, runs_of, write_light_report
from .light_pictures import LightPictures, Shot, render_light
from .pictures import Pictures, render_pictures
from .show_comparison import REFLECTION_PICTURES, load_pictures, remember, show_picture

__all__ = ["LIGHT_PICTURES", "LightPictures", "Lit", "MESH", "OWN", "Pictures", "REFLECTION_PICTURES", "Renders",
           "Shot", "Surroundings", "against_rays", "comparison_pictures", "load_pictures", "remember",
           "render_comparison", "render_light", "render_pictures", "runs_of", "show_picture", "write_light_report",
           "write_report"]
