"""The forward reflection method on plain NumPy arrays; knows nothing of Blender."""
from .culling import PointTree, SceneTree
from .geometry import TriangleMesh, View
from .reflection import ReflectionError, reflect, reflection_steps
from .result import Discs, ReflectionMesh, reflecting_normals
from .solver import Images, project
from .support import METHODS, PLACEMENTS, Settings, in_steps

__all__ = ["Discs", "Images", "METHODS", "PLACEMENTS", "PointTree", "ReflectionError", "ReflectionMesh", "SceneTree",
           "Settings", "TriangleMesh", "View", "in_steps", "project", "reflect", "reflecting_normals",
           "reflection_steps"]
