"""The light that mirrors throw on objects, in the picture of the objects' light.

Its meshes lie before the objects, where no bake looks: they are laid out as that picture is, and Cycles draws them.
"""
from .thrown_light import thrown_light

__all__ = ["thrown_light"]
