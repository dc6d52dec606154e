"""Arrays as Blender's data: meshes, points, the objects that carry them, windows, and records of the making."""
from .arrays import (
    ARRIVAL,
    DISC_SCALE,
    LATER_COSINE,
    LATER_MATERIAL,
    MOST_UV_MAPS,
    NORMAL,
    UV_MAP,
    Attribute,
    Edges,
    MeshArrays,
    images_of,
    light_layer,
    light_points,
    mesh_arrays,
    mesh_bytes,
    point_arrays,
    shown_layers,
    size_text,
    vertices_written,
)
from .beside import link_beside
from .cameras import as_shown, show_for_camera
from .halved_edges import edges_that_stray, halve_edges
from .joined_parts import set_free, told_of
from .kept_changes import PREVIEW, place_of, put_back_materials
from .landmarks import applied_to, forget_landmarks
from .nodes import Builder, disc_nodes, forget_nodes, forget_unblurred, hide_discs, show_unblurred, unblurred_in
from .protection import protect
from .records import LONGEST as LONGEST_RECORD
from .result_collection import forget_collection, gather, show_in_layer
from .windows import InTheWay, close_abandoned_windows, nearer, set_window, what_is_in_the_way
from .write_mesh import FIELDS, write_mesh
from .write_object import (
    RAYS,
    Reflection,
    Written,
    forget_mesh,
    new_beside,
    new_object,
    remember_parts,
    result_name,
    show_own_materials,
    write_object,
)

__all__ = ["ARRIVAL", "Attribute", "Builder", "DISC_SCALE", "Edges", "FIELDS", "InTheWay", "LATER_COSINE",
           "LATER_MATERIAL", "LONGEST_RECORD",
           "MOST_UV_MAPS", "MeshArrays", "NORMAL", "PREVIEW", "RAYS", "Reflection", "UV_MAP", "Written", "applied_to",
           "as_shown", "close_abandoned_windows", "disc_nodes", "edges_that_stray", "forget_collection",
           "forget_landmarks", "forget_mesh", "forget_nodes", "forget_unblurred", "gather", "halve_edges",
           "hide_discs", "images_of", "light_layer", "light_points", "link_beside", "mesh_arrays", "mesh_bytes",
           "nearer", "new_beside", "new_object", "place_of", "point_arrays", "protect", "put_back_materials",
           "remember_parts", "result_name", "set_free", "set_window", "show_for_camera", "show_in_layer",
           "show_own_materials", "show_unblurred", "shown_layers", "size_text", "told_of", "unblurred_in",
           "vertices_written", "what_is_in_the_way", "write_mesh", "write_object"]
