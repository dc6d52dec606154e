"""The light that mirrors throw: Blender's lamps as places that light comes from, and what it does where it falls.

In come lamps, a mirror's material and faces with irradiance; out come objects that add the light to what they lie on.
"""
from .caustic_arrays import MirrorPlaces, caustic_arrays
from .caustic_material import adds_light, forget_added_light, light_alone
from .in_the_way import blockers_of, blocking
from .light_sources import (
    NO_LAMP,
    Eye,
    NoLight,
    chosen_lamps,
    eyes_of,
    instancers_of_lamps,
    is_glint,
    is_mesh_lamp,
    is_met,
    is_sheared,
    light_of_nodes,
    meant_lamps,
    radiance_of,
    rays_meet,
)
from .mirrors import MirrorColours, MirrorPart, Tint, is_bumped, parts_of, places_on_mirror, stains, textured
from .not_twice import (
    bring_back_abandoned,
    bring_back_own_caustics,
    follow_lamp,
    is_shown_in,
    leave_out,
    leave_out_own_caustics,
    leaves_out,
    leaves_out_any,
    let_lamps_light_mirrors,
    makes_own_caustics,
)
from .sheets import Receiving, let_through, receiving
from .transparent_layers import bring_back_layers, follow_layers, raises_layers
from .write_caustics import Caustic, caustics_object, places_kept, results_with, write_caustics

__all__ = ["Caustic", "Eye", "MirrorColours", "MirrorPart", "MirrorPlaces", "NO_LAMP", "NoLight", "Receiving", "Tint",
           "adds_light", "blockers_of", "blocking", "bring_back_abandoned", "bring_back_layers",
           "bring_back_own_caustics", "caustic_arrays", "caustics_object", "chosen_lamps", "eyes_of", "follow_lamp",
           "follow_layers", "forget_added_light", "instancers_of_lamps", "is_bumped", "is_glint", "is_mesh_lamp",
           "is_met", "is_sheared", "is_shown_in", "leave_out", "leave_out_own_caustics", "leaves_out",
           "leaves_out_any", "let_lamps_light_mirrors", "let_through", "light_alone", "light_of_nodes",
           "makes_own_caustics", "meant_lamps", "parts_of", "places_kept", "places_on_mirror", "radiance_of",
           "raises_layers", "rays_meet", "receiving", "results_with", "stains", "textured", "write_caustics"]
