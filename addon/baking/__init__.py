"""Light that stays with the objects: baked by Cycles once, shown wherever a result shows them."""
from .islands import random_by_island
from .mirror_layers import write_mirror_layers
from .object_bake import ObjectLight, baked
from .object_map import KeptMap, kept_map, knows_mirror_normals, lay_out, write_mirror_normals
from .seen_sources import are_few, can_be_baked

__all__ = ["KeptMap", "ObjectLight", "are_few", "baked", "can_be_baked", "kept_map", "knows_mirror_normals", "lay_out",
           "random_by_island", "write_mirror_layers", "write_mirror_normals"]
