"""Track the inputs that a result was made from, and report in one sentence if they have changed. Generate updates it.
"""
from .digests import digest_of, register, unregister
from .frame_origin import frame_difference, frame_origin
from .lit_from import light_difference, lit_record, lit_with, why_light_differs
from .made_from import (
    COARSE,
    Origin,
    origin_of,
    record_of,
    same_view,
    settings_of,
    view_numbers,
    why_stale,
)
from .thrown_light import lamp_numbers, light_record, why_light_is_stale

__all__ = ["COARSE", "Origin", "digest_of", "frame_difference", "frame_origin", "lamp_numbers", "light_difference",
           "light_record", "lit_record", "lit_with", "origin_of", "record_of", "register", "same_view", "settings_of",
           "unregister", "view_numbers", "why_light_differs", "why_light_is_stale", "why_stale"]
