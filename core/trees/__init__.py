"""Trees over the scene, and what goes down them: cones of cameras, balls, and rays.

In come meshes and the rays of cameras; out come pairs that may meet, and what rays meet first. J. L. Bentley, CACM 1975
(k-d trees); I. Wald, 2007 (boxes for rays).
"""
from .bounded_trace import Bound, Touching, bounded_trace
from .box_tree import BoxTree
from .cones import Balls, Cones
from .first_crossed import first_crossed
from .first_hits import first_hits, meet
from .magnification import Magnification
from .node_tree import curve_leaves, depth_for, median_leaves
from .point_tree import PointTree
from .scene_tree import SceneTree

__all__ = ["Balls", "Bound", "BoxTree", "Cones", "Magnification", "PointTree", "SceneTree", "Touching", "bounded_trace",
           "curve_leaves", "depth_for", "first_crossed", "first_hits", "median_leaves", "meet"]
