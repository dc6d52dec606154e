"""Where Cycles bakes the light on objects: stand-ins in a temporary scene, a picture of each, in bands for a window."""
from .bake_scene import bake_scene
from .bakes import BakeScene
from .stand_ins import new_meshes, stand_ins
from .undeformed import is_deformed, undeformed_positions

__all__ = ["BakeScene", "bake_scene", "is_deformed", "new_meshes", "stand_ins", "undeformed_positions"]
