"""Light on reflections: Cycles shades what they show, along the paths on which their mirrors see it."""
from .export_image import fill_export_image, is_cut_out, straight
from .further_mirrors import FurtherMirrors
from .kept_light import KeptLight
from .known_texels import remember
from .light_material import alone, new_image, new_material, show_as_cut_out
from .light_paths import LightPaths, grown
from .lit_faces import Placed
from .lit_results import (
    can_be_lit,
    forget_light,
    is_lit,
    keep_light,
    lay_out,
    light_sentence,
    prepared,
    show_light,
    write_colours,
)
from .lit_results import record_of as light_record
from .mattes import lacks_mattes, update_mattes
from .needs_light import is_plain, needs_light, only_emits
from .path_sheet import path_scene, render_paths
from .preview import forget_previews, show_previews, shows_preview
from .unwrapping import FROM_MIRROR, Unwrapped, unwrap
from .world_faces import WORLD
from .world_material import show_world

__all__ = ["FROM_MIRROR", "FurtherMirrors", "KeptLight", "LightPaths", "Placed", "Unwrapped", "WORLD", "alone",
           "can_be_lit", "forget_light", "forget_previews", "grown", "is_cut_out", "is_lit", "is_plain", "keep_light",
           "lacks_mattes", "lay_out", "light_record", "light_sentence", "needs_light", "fill_export_image", "new_image",
           "new_material", "only_emits", "path_scene", "prepared", "remember", "render_paths", "show_as_cut_out",
           "show_light", "show_previews", "show_world", "shows_preview", "straight", "unwrap", "update_mattes",
           "write_colours"]
