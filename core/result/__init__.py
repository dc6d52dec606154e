"""Results: the reflection mesh, its discs, its placement in space, and the order of the given meshes.

In come faces on nodes, or discs, in the method's own order; out come arrays in world space and in the order of the
meshes that were given.
"""
from .discs import Discs
from .given_order import in_given_order
from .picture_pieces import PicturePieces, picture_pieces
from .placement import DEPTH, GAP, place
from .reflecting_normals import halfway, reflecting_normals
from .reflection_mesh import ReflectionMesh, filled_share

__all__ = ["DEPTH", "Discs", "GAP", "PicturePieces", "ReflectionMesh", "filled_share", "halfway", "in_given_order",
           "picture_pieces", "place", "reflecting_normals"]
