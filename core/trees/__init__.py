"""Trees over the scene, and what goes down them: cones of cameras, balls, and rays.

In come meshes and the rays of cameras; out come pairs that may meet, and what rays meet first. J. L. Bentley, CACM 1975
(k-d trees); I. Wald, 2007 (boxes for rays).
"""
from .bounded_trace import Bound, Touching, bounded_trace
from .box_tree import BoxTree
from .closed_bodies import Fronts
from .cones import Balls, Cones
from .first_crossed import first_crossed, first_of_many
from .first_hits import first_hits, meet
from .magnification import Magnification
from .node_tree import along_curve, curve_leaves, depth_for
from .point_tree import SMALL, PointTree
from .scene_tree import SceneTree
from .shafts import Shafts
from .vertex_tree import StandIns, VertexTree

__all__ = ["SMALL", "Balls", "Bound", "BoxTree", "Cones", "Fronts", "Magnification", "PointTree", "SceneTree",
           "Shafts", "StandIns", "Touching", "VertexTree", "along_curve", "bounded_trace", "curve_leaves", "depth_for",
           "first_crossed", "first_of_many", "first_hits", "meet"]
