"""What nodes of materials say: mirrors, what lets light through, and what nodes there are."""
from .material_nodes import all_nodes, asked_attributes
from .materials_of import materials_of
from .mirror_materials import MIRRORS, emits, is_exact, is_mirror, is_sharp, shines, surface_shader
from .opaque_materials import is_opaque

__all__ = ["MIRRORS", "all_nodes", "asked_attributes", "emits", "is_exact", "is_mirror", "is_opaque",
           "is_sharp", "materials_of", "shines", "surface_shader"]
