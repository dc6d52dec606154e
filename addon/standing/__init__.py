"""What stands still from one generation to the next is kept as arrays: meshes, the scene with its tree, the mirrors.

The depsgraph tells what no longer stands; where that is in doubt all is read again.
"""
from .kept import Kept, Stage
from .told import register, unregister

__all__ = ["Kept", "Stage", "register", "unregister"]
