"""What nodes of materials say: mirrors, what lets light through or has its own, and what nodes there are."""
from .carried_light import emits_alike
from .dielectric import index_of, upright
from .material_nodes import all_nodes, asked_attributes, feeding, one_output, shown_output
from .materials_of import (
    all_fog,
    all_materials_of,
    materials_of,
    materials_on_faces,
    materials_shown,
    own_materials,
    reflecting_materials,
)
from .mirror_materials import (
    FULL_METALLIC,
    MIRRORS,
    SHARP_ROUGHNESS,
    emits,
    has_sharp_coat,
    is_exact,
    is_mirror,
    is_sharp,
    shines,
    surface_shader,
)
from .opaque_materials import fog_of, is_clear, is_colourless, is_fog, is_opaque
from .own_light import glows, outshines_paper, sends_light
from .surface_shaders import surface_shaders
from .transparency import transparency

__all__ = ["FULL_METALLIC", "MIRRORS", "SHARP_ROUGHNESS", "all_fog", "all_materials_of", "all_nodes",
           "asked_attributes", "emits", "emits_alike", "feeding", "fog_of", "glows", "has_sharp_coat", "index_of",
           "is_clear", "is_colourless", "is_exact", "is_fog", "is_mirror", "is_opaque", "is_sharp", "materials_of",
           "materials_on_faces", "materials_shown", "one_output", "outshines_paper", "own_materials",
           "reflecting_materials", "sends_light", "shines", "shown_output", "surface_shader", "surface_shaders",
           "transparency", "upright"]
