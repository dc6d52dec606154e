"""Light on reflections: what Cycles shows in their mirrors, rendered once, on the faces that show it."""
from .density import make_denser, needed_density
from .light_material import new_export_image, new_image, new_material
from .light_scene import light_scene, paper_white_of, white_of
from .lit_results import (
    dull_objects,
    forget_light,
    is_lit,
    keep_light,
    light_sentence,
    show_light,
    show_object_light,
)
from .mattes import lacks_mattes, update_mattes
from .needs_light import is_plain, needs_light
from .picture import Window, beside_lamps, is_overexposed, on_the_mirror, pixel_kernel, texels_of
from .preview import forget_previews, show_previews, shows_preview

__all__ = ["Window", "beside_lamps", "dull_objects", "forget_light", "forget_previews", "is_lit", "is_overexposed",
           "is_plain", "keep_light", "lacks_mattes", "light_sentence", "light_scene", "make_denser", "needed_density",
           "needs_light", "new_export_image", "new_image", "new_material", "on_the_mirror", "paper_white_of",
           "pixel_kernel", "show_light", "show_object_light", "show_previews", "shows_preview", "texels_of",
           "update_mattes", "white_of"]
