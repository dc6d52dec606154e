"""Errors in numbers, on arrays alone: displacement and coverage of pixels, metrics of pictures, light on surfaces."""
from .bright_lines import line_offsets
from .light_errors import Squares, added, light_errors, light_in_squares
from .picture_metrics import picture_errors
from .pixel_errors import (
    ITSELF,
    NOTHING,
    OTHER_SURFACE,
    CodedPicture,
    Measurement,
    measure,
    motion_per_pixel,
    percentages,
    without_packing,
)

__all__ = ["CodedPicture", "ITSELF", "Measurement", "NOTHING", "OTHER_SURFACE", "Squares", "added", "light_errors",
           "light_in_squares", "line_offsets", "measure", "motion_per_pixel", "percentages",
           "picture_errors", "without_packing"]
