"""Occlusion: by the eye's plane, the mirror's own body, objects that pass through it, mirrors before the scene.

In come cameras or polygons; out come their visible parts, cut along outlines, which are linear in a camera's weights.
"""
from .clear_panes import slide_share
from .eye_plane import cut_before_eye
from .lamp_light import cut_at_borders, lit, with_shades
from .mirror_occlusion import cut_behind_mirrors
from .mirror_visibility import without_hidden
from .scene_contacts import drop_behind_contacts
from .self_occlusion import without_occluded
from .touching_mirrors import plainly_seen

__all__ = ["cut_at_borders", "cut_before_eye", "cut_behind_mirrors", "drop_behind_contacts", "lit", "plainly_seen",
           "slide_share", "with_shades", "without_hidden", "without_occluded"]
