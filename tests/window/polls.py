"""The polls of the extension's operators and panels, to be called by themselves: where one fails, Blender itself prints
that and takes it for no."""
from __future__ import annotations

import bpy

KINDS = (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)


def polls_of_the_extension() -> dict:
    """The classes that have a poll of their own, by their names in `bpy.types`."""
    return {cls.__name__: cls for kind in KINDS for cls in kind.__subclasses__()
            if ".reflection_mesh." in cls.__module__ and cls.is_registered and "poll" in dir(cls)}
