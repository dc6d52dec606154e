"""Support for all packages: checks of arguments, errors, settings, and long work in steps with progress.

In come arguments as the caller gave them, and functions that take long; out come checked arrays and numbers, errors of
one sentence, and generators that yield the progress.
"""
from .checks import LARGEST, must_be, number, numbers, whole_number, whole_numbers
from .crowding import crowded
from .error_budget import (
    BESIDE_EDGES,
    DOUBT_SHARE,
    ENDING_SHARE,
    FACE_SHARE,
    INSIDE,
    INSIDE_WHOLE,
    MIRROR_SHARE,
    OUTLINE_SHARE,
    TOGETHER,
    TOGETHER_AT_OUTLINES,
    WHOLE_OUTLINE_SHARE,
)
from .errors import NothingInView, ReflectionError
from .heap import keep_freed_memory
from .parallel import in_parallel, use_threads
from .progress import Progress
from .settings import LEFT, METHODS, MOST_BOUNCES, PLACEMENTS, Settings
from .stepping import breathe, in_steps, portions, tell

__all__ = ["BESIDE_EDGES", "DOUBT_SHARE", "ENDING_SHARE", "FACE_SHARE", "INSIDE", "INSIDE_WHOLE", "LARGEST", "LEFT",
           "METHODS", "MIRROR_SHARE", "MOST_BOUNCES", "NothingInView", "OUTLINE_SHARE", "PLACEMENTS", "Progress",
           "ReflectionError", "Settings", "TOGETHER", "TOGETHER_AT_OUTLINES", "WHOLE_OUTLINE_SHARE", "breathe",
           "crowded", "in_parallel", "in_steps", "keep_freed_memory", "must_be", "number", "numbers", "portions",
           "tell", "use_threads", "whole_number", "whole_numbers"]
