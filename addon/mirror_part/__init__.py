"""What mirrors make of the light that they show: their shaders, with light in place of what is glossy in them."""
from .later_mirrors import LATER, LaterMirrors, write_later_tints
from .mirror_coordinates import BACK, GENERATED, OWN_NORMAL, OWN_PLACE, asks_for_places, own_layer
from .mirror_part import MirrorPart, Surroundings, copied_shaders
from .object_material import new_object_material
from .opacity import as_mirrors_see, hide_own_light, show_opacity, turn_over, without_openings
from .several_materials import MATERIAL

__all__ = ["BACK", "GENERATED", "LATER", "LaterMirrors", "MATERIAL", "MirrorPart", "OWN_NORMAL", "OWN_PLACE",
           "Surroundings", "as_mirrors_see", "asks_for_places", "copied_shaders", "hide_own_light",
           "new_object_material", "own_layer", "show_opacity", "turn_over", "without_openings", "write_later_tints"]
