"""The picture of light: the part of the render that it is rendered in, its texels, and where results lie in it."""
from .picture_layout import SHINING, lay_out, shining_slots
from .picture_light import record_of, window_of
from .texels import beside_lamps, is_overexposed, pixel_kernel, texels_of
from .window import Window, on_the_mirror

__all__ = ["SHINING", "Window", "beside_lamps", "is_overexposed", "lay_out", "on_the_mirror", "pixel_kernel",
           "record_of", "shining_slots", "texels_of", "window_of"]
