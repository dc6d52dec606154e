"""What is said where nothing is to be seen in a mirror at the moment, and may be at another one."""
from __future__ import annotations

from ...core import ReflectionError


class NothingSeen(ReflectionError):
    """There is a mirror, and something to reflect, and nothing of it is to be seen at the moment."""
