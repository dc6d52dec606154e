"""Which triangles and vertices a camera may see: bounding cones of its rays, traced through a k-d tree.

In come cameras and meshes; out come candidates, pairs of a camera and a triangle with the linear functions that bound
what the one sees of the other.
"""
from .box_tree import BoxTree
from .candidates import Candidates, overlapping
from .cones import Balls, Cones
from .first_crossed import first_crossed
from .first_hits import first_hits, meet
from .magnification import Magnification
from .mirrors_shown import MirrorsShown
from .node_tree import median_leaves
from .point_tree import PointTree
from .scene_and_mirrors import ABOVE, SceneAndMirrors
from .scene_pieces import ScenePieces
from .scene_tree import SceneTree

__all__ = ["ABOVE", "Balls", "BoxTree", "Candidates", "Cones", "Magnification", "MirrorsShown", "PointTree",
           "SceneAndMirrors", "ScenePieces", "SceneTree", "first_crossed", "first_hits", "median_leaves", "meet",
           "overlapping"]
