"""Cycles at work on temporary scenes; what it renders comes back as arrays, pictures of pixels with neighbours."""
from .cycles_pictures import Renders, crop_to, denoise, render_stage, rendered, rendering, shown_while, with_cycles
from .neighbours import continued, grown, sum_around
from .own_collections import OwnCollections
from .scene_copies import MOST_SEED, SEEN, copied_scene, look_through, only_the_picture, sharp_camera, show_mirrors
from .swift_world import put_swift_world

__all__ = ["MOST_SEED", "OwnCollections", "Renders", "SEEN", "continued", "copied_scene", "crop_to", "denoise", "grown",
           "look_through", "only_the_picture", "put_swift_world", "render_stage", "rendered", "rendering",
           "sharp_camera", "show_mirrors", "shown_while", "sum_around", "with_cycles"]
