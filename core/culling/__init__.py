"""What cameras may see: pairs of a camera and a triangle, found by bounding cones of the camera's rays in trees.

In come cameras and meshes; out come candidates, pairs of a camera and a triangle with the linear functions that bound
what the one sees of the other.
"""
from .candidates import Candidates, inherited, overlapping
from .mirrors_shown import MirrorsShown
from .opacities import Opacities
from .scene_and_mirrors import ABOVE, SceneAndMirrors
from .scene_pieces import ScenePieces

__all__ = ["ABOVE", "Candidates", "MirrorsShown", "Opacities", "SceneAndMirrors", "ScenePieces", "inherited",
           "overlapping"]
