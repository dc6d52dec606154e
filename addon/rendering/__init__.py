"""Cycles at work on temporary scenes; what it renders comes back as arrays."""
from .cycles_pictures import denoise, rendered, with_cycles
from .scene_copies import copied_scene, look_through

__all__ = ["copied_scene", "denoise", "look_through", "rendered", "with_cycles"]
