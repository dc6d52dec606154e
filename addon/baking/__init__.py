"""Light that stays with the objects: baked by Cycles once, shown wherever a result shows them."""
from .mirror_part import new_object_material
from .object_bake import ObjectLight, baked
from .object_map import KeptMap, kept_map, lay_out
from .seen_sources import can_be_baked, vectors

__all__ = ["KeptMap", "ObjectLight", "baked", "can_be_baked", "kept_map", "lay_out", "new_object_material", "vectors"]
