"""What mirrors make of a lamp's light: their colours, by angle and by place, and the parts of each that have one.

In come mirrors as they were read, with their materials; out come parts of one tint, and what is left of light.
"""
from .lobes import is_bumped
from .mirror_colours import MirrorColours
from .mirror_parts import MirrorPart, parts_of
from .mirror_textures import PER_COLOUR, mirror_attributes, places_on_mirror, stains, textured
from .tint import Tint, has_mirrors

__all__ = ["MirrorColours", "MirrorPart", "PER_COLOUR", "Tint", "has_mirrors", "is_bumped", "mirror_attributes",
           "parts_of", "places_on_mirror", "stains", "textured"]
