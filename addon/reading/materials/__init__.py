"""Read properties from the shader nodes of materials: mirrors, transparency, emission and the nodes themselves."""
from .carried_light import emits_alike
from .dielectric import index_of, upright
from .image_samples import look_again
from .material_nodes import all_nodes, asked_attributes, feeding, is_displaced, one_output, shown_output
from .materials_of import (
    all_fog,
    all_materials_of,
    goes_by_name,
    instanced_materials,
    instances_otherwise,
    materials_of,
    materials_on_faces,
    materials_shown,
    own_materials,
    reflecting_materials,
)
from .mirror_materials import (
    MIRRORS,
    SHARP_ROUGHNESS,
    emits,
    has_sharp_coat,
    is_exact,
    is_metal,
    is_mirror,
    is_sharp,
    least_roughness,
    mirror_roughness,
    mirrors_in_part,
    shines,
    which_reflect,
)
from .opaque_materials import fog_of, is_clear, is_colourless, is_fog, is_opaque
from .own_light import glows, outshines_paper, sends_light
from .shader_graph import MIXING, Groups, fed_by, outermost, surface_shader, surface_shaders
from .steady_light import steady_angle
from .transparency import transparency

__all__ = ["FULL_METALLIC", "Groups", "MIRRORS", "MIXING", "SHARP_ROUGHNESS", "all_fog", "all_materials_of",
           "all_nodes", "asked_attributes", "emits", "emits_alike", "fed_by", "feeding", "fog_of", "glows",
           "goes_by_name", "has_sharp_coat", "index_of", "instanced_materials", "instances_otherwise", "is_clear",
           "is_colourless", "is_displaced", "is_exact", "is_fog", "is_metal", "is_mirror", "is_opaque", "is_sharp",
           "least_roughness", "look_again", "materials_of", "materials_on_faces", "materials_shown",
           "mirror_roughness", "mirrors_in_part", "one_output", "outermost", "outshines_paper", "own_materials",
           "reflecting_materials", "sends_light", "shines", "shown_output", "steady_angle", "surface_shader",
           "surface_shaders", "transparency", "upright", "which_reflect"]
