"""The forward reflection method on plain NumPy arrays; knows nothing of Blender."""
from .discs import Discs
from .point_tree import PointTree
from .projection import Images, project
from .reflection import ReflectionError, reflect, reflection_steps
from .reflection_mesh import ReflectionMesh
from .scene_tree import SceneTree
from .settings import METHODS, PLACEMENTS, Settings
from .stepping import in_steps
from .triangle_mesh import TriangleMesh
from .view import View

__all__ = ["Discs", "Images", "METHODS", "PLACEMENTS", "PointTree", "ReflectionError", "ReflectionMesh", "SceneTree",
           "Settings", "TriangleMesh", "View", "in_steps", "project", "reflect", "reflection_steps"]
