"""Cache arrays between generations: meshes, the scene with its tree, and the mirrors.

The depsgraph reports changes. In case of doubt everything is read again.
"""
from .kept import Kept, Stage
from .told import register, unregister

__all__ = ["Kept", "Stage", "register", "unregister"]
