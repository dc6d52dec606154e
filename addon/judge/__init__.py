"""Cycles as the judge: a scene of codes in place of colours, rendered, and what its pixels say."""
from .cycles_codes import CodedMaterials
from .cycles_render import render_picture, take_settings
from .cycles_scene import CopiedScene, copied_scene
from .cycles_truth import CodedTruth, decode, lowest_corner, mirror_all, polygons, show

__all__ = ["CodedMaterials", "CodedTruth", "CopiedScene", "copied_scene", "decode", "lowest_corner", "mirror_all",
           "polygons", "render_picture", "show", "take_settings"]
