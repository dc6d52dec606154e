"""The light that mirrors throw: Blender's lamps as places that light comes from, and what it does where it falls.

In come lamps, a mirror's material and faces with irradiance; out come objects that add the light to what they lie on.
"""
from .caustic_arrays import caustic_arrays
from .caustic_material import adds_light, forget_added_light
from .lamps import Eye, chosen_lamps, eyes_of, has_a_size
from .own_caustics import bring_back_abandoned, leave_out_own_caustics
from .tint import Tint
from .write_caustics import Caustic, results_with, write_caustics

__all__ = ["Caustic", "Eye", "Tint", "adds_light", "bring_back_abandoned", "caustic_arrays", "chosen_lamps",
           "eyes_of", "forget_added_light", "has_a_size", "leave_out_own_caustics", "results_with", "write_caustics"]
