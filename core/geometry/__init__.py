"""Triangle meshes and vectors: plain geometry on arrays, component-first (3, n) inside the method.

Input are meshes. Output are meshes in canonical order, which depends only on the places of vertices, and the adjacency
of triangles.
"""
from .adjacency import borders, connected, corners_beyond
from .canonical_order import TURNS, Order, ordered
from .column_arrays import ColumnArrays
from .distinct import distinct, first_of, in_order
from .marked import mask, numbered
from .near_triangles import meeting
from .opacity import Opacity
from .scene_frames import SceneFrames, falling
from .subdivision import (
    areas,
    doubled_areas,
    edge_lengths,
    edge_numbers,
    following,
    next_corner,
    others,
    parent_side,
    shared_edges,
    solid_angles,
    split,
)
from .triangle_mesh import TriangleMesh, area_normals, areal, has_area
from .vectors import (
    across,
    between,
    columns,
    cross,
    dot,
    groups,
    largest,
    norm,
    ranges,
    rows,
    shares,
    smallest,
    solve,
    spread_directions,
    unit,
)

__all__ = ["ColumnArrays", "Opacity", "Order", "SceneFrames", "TURNS", "TriangleMesh", "across", "area_normals",
           "areal", "areas", "between", "borders", "columns", "connected", "corners_beyond", "cross", "distinct", "dot",
           "doubled_areas", "edge_lengths", "edge_numbers", "falling", "first_of", "following", "groups", "has_area",
           "in_order", "largest", "mask", "meeting", "next_corner", "norm", "numbered", "ordered", "others",
           "parent_side", "ranges", "rows", "shared_edges", "shares", "smallest", "solid_angles", "solve", "split",
           "spread_directions", "unit"]
