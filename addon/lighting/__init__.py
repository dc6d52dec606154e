"""Light on reflections: what Cycles shows in their mirrors, rendered once, on the faces that show it."""
from .light_material import new_export_image, new_image, new_material
from .light_scene import Window, light_scene, white_of
from .lit_results import forget_light, keep_light, light_lines, mirror_positions, show_light
from .needs_light import needs_light
from .texels import pixel_kernel, texels_of

__all__ = ["Window", "forget_light", "keep_light", "light_lines", "light_scene", "mirror_positions", "needs_light",
           "new_export_image", "new_image", "new_material", "pixel_kernel", "show_light", "texels_of", "white_of"]
