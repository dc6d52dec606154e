"""Light that stays with the objects: baked by Cycles once, shown wherever a result shows them."""
from .later_mirrors import LaterMirrors
from .mirror_part import Surroundings, new_object_material
from .mirror_share import WHITE, Share
from .object_bake import ObjectLight, baked
from .object_map import KeptMap, kept_map, lay_out, write_mirror_normals
from .opacity import opacity_of
from .seen_sources import are_few, can_be_baked, vectors

__all__ = ["KeptMap", "LaterMirrors", "ObjectLight", "Share", "Surroundings", "WHITE", "are_few", "baked",
           "can_be_baked", "kept_map", "lay_out", "new_object_material", "opacity_of", "vectors",
           "write_mirror_normals"]
