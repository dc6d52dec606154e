"""Shaders of mirrors for showing reflected light: their own shaders, with emission in place of glossy reflection."""
from .later_mirrors import LATER, LaterMirrors, write_later_tints
from .mirror_coordinates import BACK, GENERATED, OWN_NORMAL, OWN_PLACE, asks_for_places, own_layer
from .mirror_layers import knows_mirror_normals, write_mirror_layers, write_mirror_normals
from .mirror_part import MirrorPart, Surroundings, copied_shaders
from .several_materials import MATERIAL

__all__ = ["BACK", "GENERATED", "LATER", "LaterMirrors", "MATERIAL", "MirrorPart", "OWN_NORMAL", "OWN_PLACE",
           "Surroundings", "asks_for_places", "copied_shaders", "knows_mirror_normals", "own_layer",
           "write_later_tints", "write_mirror_layers", "write_mirror_normals"]
