"""What comes out: the reflection mesh, its discs, where it is drawn, and in whose numbers it is told."""
from .discs import Discs
from .given_order import in_given_order
from .picture_pieces import PicturePieces, picture_pieces
from .placement import DEPTH, GAP, place
from .reflecting_normals import halfway, reflecting_normals
from .reflection_mesh import ReflectionMesh

__all__ = ["DEPTH", "Discs", "GAP", "PicturePieces", "ReflectionMesh", "halfway", "in_given_order", "picture_pieces",
           "place", "reflecting_normals"]
