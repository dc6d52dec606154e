"""Errors in numbers, on arrays alone: displacement and coverage of pixels, and metrics of pictures."""
from .picture_metrics import picture_errors
from .pixel_errors import (
    ITSELF,
    NOTHING,
    OTHER_SURFACE,
    CodedPicture,
    Measurement,
    measure,
    motion_per_pixel,
    without_packing,
)

__all__ = ["CodedPicture", "ITSELF", "Measurement", "NOTHING", "OTHER_SURFACE", "measure", "motion_per_pixel",
           "picture_errors", "without_packing"]
