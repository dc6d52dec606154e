"""The error for a mirror that shows nothing at this moment, but may at another frame."""
from __future__ import annotations

from ...core import ReflectionError


class NothingSeen(ReflectionError):
    """There are a mirror and objects to reflect, but nothing of them is visible at this moment."""
