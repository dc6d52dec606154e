"""What every room needs: arguments checked, errors, settings, long work in steps that tell how far it is."""
from .checks import LARGEST, must_be, number, numbers, whole_number, whole_numbers
from .crowding import crowded
from .error_budget import FACE_SHARE, MIRROR_SHARE, OUTLINE_SHARE
from .errors import NothingInView, ReflectionError
from .heap import keep_freed_memory
from .progress import Progress
from .settings import METHODS, PLACEMENTS, Settings
from .stepping import breathe, in_steps, portions, tell

__all__ = ["FACE_SHARE", "LARGEST", "METHODS", "MIRROR_SHARE", "NothingInView", "OUTLINE_SHARE", "PLACEMENTS",
           "Progress", "ReflectionError", "Settings", "breathe", "crowded", "in_steps", "keep_freed_memory", "must_be",
           "number", "numbers", "portions", "tell", "whole_number", "whole_numbers"]
