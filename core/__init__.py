"""The forward reflection method on plain NumPy arrays; knows nothing of Blender."""
from .caustics import CausticMesh, Lamp, caustic_steps, caustics
from .culling import PointTree, SceneTree
from .geometry import TriangleMesh, View, draw
from .reflection import ReflectionError, reflect, reflection_steps
from .result import Discs, PicturePieces, ReflectionMesh, picture_pieces, reflecting_normals
from .solver import Images, project
from .support import METHODS, PLACEMENTS, Settings, in_steps

__all__ = ["CausticMesh", "Discs", "Images", "Lamp", "METHODS", "PLACEMENTS", "PicturePieces", "PointTree",
           "ReflectionError", "ReflectionMesh", "SceneTree", "Settings", "TriangleMesh", "View", "caustic_steps",
           "caustics", "draw", "in_steps", "picture_pieces", "project", "reflect", "reflecting_normals",
           "reflection_steps"]
