"""Blender's data as arrays: who takes part, meshes with their layers, materials, the view."""
from .assemblies import Assembly, assemblies, root_of
from .hidden_objects import (
    NO_MIRROR,
    Participants,
    in_viewports,
    nothing_to_reflect,
    rendered_collections,
    rendered_in,
    seen_in,
    visible,
    why_caught,
)
from .known_results import forget_known, known_results, register, unregister
from .light_links import LINKS, is_linked, link_state
from .lines import lines_drawn, redraw_lines
from .looked_through import looked_through
from .materials import (
    SHARP_ROUGHNESS,
    all_nodes,
    fog_of,
    goes_by_name,
    instances_otherwise,
    is_clear,
    is_fog,
    is_mirror,
    is_opaque,
    least_roughness,
    materials_of,
    materials_shown,
    mirror_roughness,
)
from .meshes import (
    DiffuseScene,
    LocalMesh,
    MirrorSurface,
    Placed,
    corner_vertices,
    drawn_meshes,
    is_rendered,
    join_mirror,
    join_scene,
    numbers,
    read_meshes,
    read_mirror,
    read_mirrors,
    read_scene,
    takes_part,
    vectors,
)
from .metaballs import is_part
from .mirror_objects import can_take_part, may_have_faces, may_say_mirror, says_mirror
from .moves import forgets_particles, moves
from .not_reflected import has_fog, in_background_set, rendered_alone, without_surface
from .nothing_seen import NothingSeen
from .opacities import opacities_of
from .read_view import NO_CAMERA, read_view, render_size, with_square_pixels
from .rendered_otherwise import rendered_otherwise
from .results import (
    RESULTS,
    camera_of,
    every_result_of,
    has_linked_results,
    is_gone,
    is_result,
    lost_mirror,
    mirrors_of,
    named_by_selection,
    result_of,
    results_of,
    with_copies,
)
from .roles import candidates, choose, participants, seen_by_camera, shadow_catchers, shown_by, without_shadow_catchers

__all__ = ["Assembly", "DiffuseScene", "LINKS", "LocalMesh", "MirrorSurface", "NO_CAMERA", "NO_MIRROR", "NothingSeen",
           "Participants", "Placed", "RESULTS", "SHARP_ROUGHNESS", "all_nodes", "assemblies", "camera_of",
           "can_take_part", "candidates", "choose", "corner_vertices", "drawn_meshes", "every_result_of", "fog_of",
           "forget_known", "forgets_particles", "goes_by_name", "has_fog", "has_linked_results", "in_background_set",
           "in_viewports", "instances_otherwise", "is_clear", "is_fog", "is_gone", "is_linked", "is_mirror",
           "is_opaque", "is_part", "is_rendered", "is_result", "join_mirror", "join_scene", "known_results",
           "least_roughness", "lines_drawn", "link_state", "looked_through", "lost_mirror", "materials_of",
           "materials_shown", "may_have_faces", "may_say_mirror", "mirror_roughness", "mirrors_of", "moves",
           "named_by_selection", "nothing_to_reflect", "numbers", "opacities_of", "participants", "read_meshes",
           "read_mirror", "read_mirrors", "read_scene", "read_view", "redraw_lines", "register", "render_size",
           "rendered_alone", "rendered_collections", "rendered_in", "rendered_otherwise", "result_of", "results_of",
           "root_of", "says_mirror", "seen_by_camera", "seen_in", "shadow_catchers", "shown_by", "takes_part",
           "unregister", "vectors", "visible", "why_caught", "with_copies", "with_square_pixels",
           "without_shadow_catchers", "without_surface"]
