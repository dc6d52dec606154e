"""What mirrors make of the light that they show: their shaders, with light in place of what is glossy in them."""
from .later_mirrors import LATER, LaterMirrors, write_later_tints
from .mirror_coordinates import BACK, OWN_NORMAL, OWN_PLACE, own_layer
from .mirror_part import Surroundings, new_object_material
from .mirror_share import WHITE, Share
from .opacity import as_mirrors_see, hide_own_light, opacity_of, show_opacity, turn_over, without_openings
from .several_materials import MATERIAL, by_material

__all__ = ["BACK", "LATER", "LaterMirrors", "MATERIAL", "OWN_NORMAL", "OWN_PLACE", "Share", "Surroundings", "WHITE",
           "as_mirrors_see", "by_material", "hide_own_light", "new_object_material", "opacity_of", "own_layer",
           "show_opacity", "turn_over", "without_openings", "write_later_tints"]
