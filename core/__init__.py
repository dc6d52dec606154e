"""The forward reflection method on plain NumPy arrays; knows nothing of Blender."""
from .caustics import CausticMesh, Lamp, caustic_steps, caustics
from .following import FollowedImages
from .geometry import Opacity, TriangleMesh
from .lines import with_borders_closed
from .reflection import reflect, reflection_steps
from .result import Discs, PicturePieces, ReflectionMesh, picture_pieces, reflecting_normals
from .solver import Images, project
from .standing import Standing
from .support import METHODS, PLACEMENTS, NothingInView, ReflectionError, Settings, breathe, in_steps, use_threads
from .trees import PointTree, SceneTree
from .views import View, draw, pages_of

__all__ = ["CausticMesh", "Discs", "FollowedImages", "Images", "Lamp", "METHODS", "NothingInView", "Opacity",
           "PLACEMENTS", "PicturePieces", "PointTree", "ReflectionError", "ReflectionMesh", "SceneTree", "Settings",
           "Standing", "TriangleMesh", "View", "breathe", "caustic_steps", "caustics", "draw", "in_steps", "pages_of",
           "picture_pieces", "project", "reflect", "reflecting_normals", "reflection_steps", "use_threads",
           "with_borders_closed"]
