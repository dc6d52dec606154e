"""Light that stays with the objects: baked by Cycles once, shown wherever a result shows them."""
from .mirror_part import UV_MAP, new_object_material
from .object_bake import ObjectLight, baked
from .object_map import kept_map, lay_out, map_of
from .seen_sources import can_be_baked, corner_vertices, vectors

__all__ = ["ObjectLight", "UV_MAP", "baked", "can_be_baked", "corner_vertices", "kept_map", "lay_out", "map_of",
           "new_object_material", "vectors"]
