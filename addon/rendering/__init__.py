"""Cycles at work on temporary scenes; what it renders comes back as arrays."""
from .cycles_pictures import Renders, crop_to, denoise, render_stage, rendered, rendering, shown_while, with_cycles
from .scene_copies import MOST_SEED, SEEN, copied_scene, look_through, only_the_picture, sharp_camera, show_mirrors
from .swift_world import put_swift_world

__all__ = ["MOST_SEED", "Renders", "SEEN", "copied_scene", "crop_to", "denoise", "look_through", "only_the_picture",
           "put_swift_world", "render_stage", "rendered", "rendering", "sharp_camera", "show_mirrors", "shown_while",
           "with_cycles"]
