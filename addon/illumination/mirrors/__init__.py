"""Compute the light that mirrors reflect: their colours by angle and position, and their parts of one colour.

Input are mirrors with their materials. Output are parts with one tint, and the remaining light.
"""
from .lobes import is_bumped
from .mirror_colours import MirrorColours
from .mirror_parts import MirrorPart, parts_of
from .mirror_textures import PER_COLOUR, mirror_attributes, places_on_mirror, stains, textured
from .tint import Tint, has_mirrors

__all__ = ["MirrorColours", "MirrorPart", "PER_COLOUR", "Tint", "has_mirrors", "is_bumped", "mirror_attributes",
           "parts_of", "places_on_mirror", "stains", "textured"]
