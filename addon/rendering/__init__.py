"""Cycles at work on temporary scenes; what it renders comes back as arrays, pictures of pixels with neighbours."""
from .cycles_pictures import crop_to, denoise, rendered, with_cycles
from .neighbours import continued, grown, sum_around
from .scene_copies import copied_scene, look_through, only_the_picture, sharp_camera, show_mirrors
from .swift_world import put_swift_world

__all__ = ["continued", "copied_scene", "crop_to", "denoise", "grown", "look_through", "only_the_picture",
           "put_swift_world", "rendered", "sharp_camera", "show_mirrors", "sum_around", "with_cycles"]
