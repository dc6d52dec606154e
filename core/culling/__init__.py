"""Culling: pairs of a camera and a triangle that it may see, found with bounding cones of the camera's rays in trees.

Input are cameras and meshes. Output are candidates: pairs of a camera and a triangle, with the linear functions that
bound the visible part of the triangle.
"""
from .candidates import Candidates, inherited, overlapping
from .mirrors_shown import MirrorsShown
from .opacities import Opacities
from .scene_and_mirrors import ABOVE, SceneAndMirrors
from .scene_pieces import ScenePieces

__all__ = ["ABOVE", "Candidates", "MirrorsShown", "Opacities", "SceneAndMirrors", "ScenePieces", "inherited",
           "overlapping"]
