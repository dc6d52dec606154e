"""Caustics: the light of a lamp that a mirror throws, by the reflection seen from the lamp.

In come a lamp, a mirror and what its light may fall on; out come faces on that, with the irradiance at their corners.
Where the lamp sees a point in the mirror, the mirror throws light on it: the inverse derivative of the true map from
the lamp's picture to the point is the irradiance there. D. Mitchell, P. Hanrahan, "Illumination from Curved
Reflectors", SIGGRAPH 1992.
"""
from .caustic_mesh import CausticMesh
from .caustics import caustic_steps, caustics
from .lamps import Lamp
from .layers import most_layers

__all__ = ["CausticMesh", "Lamp", "caustic_steps", "caustics", "most_layers"]
