"""Cycles as the judge: a scene of codes in place of colours, rendered, and what its pixels say."""
from .clear_copies import clear_before_mirrors
from .cycles_codes import CodedMaterials
from .cycles_render import render_picture, take_settings
from .cycles_scene import CopiedScene, copied_scene
from .cycles_truth import CodedTruth, decode, dress, lowest_corner, polygons, reflecting, show

__all__ = ["CodedMaterials", "CodedTruth", "CopiedScene", "clear_before_mirrors", "copied_scene", "decode", "dress",
           "lowest_corner", "polygons", "reflecting", "render_picture", "show", "take_settings"]
