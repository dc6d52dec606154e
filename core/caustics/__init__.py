"""Caustics: the light of a lamp that a mirror reflects, computed from the reflection seen from the lamp.

Input are a lamp, a mirror and receivers. Output are faces on the receivers, with the irradiance at their corners. A
point is lit by the mirror if the lamp sees it in the mirror. The irradiance there is the inverse derivative of the true
map from the lamp's picture to the point. D. Mitchell, P. Hanrahan, "Illumination from Curved Reflectors", SIGGRAPH
1992.
"""
from .caustic_mesh import CausticMesh
from .caustics import caustic_steps, caustics
from .lamps import Lamp
from .layers import most_layers

__all__ = ["CausticMesh", "Lamp", "caustic_steps", "caustics", "most_layers"]
