"""Light that mirrors throw, played from baked frames."""
from __future__ import annotations

import bpy

from ..faults import AllOrNothing
from ..illumination import adds_light, caustics_object, forget_added_light, results_with, stains, textured
from .play import Player, material_of, show_frames


def play_caustics(context: bpy.types.Context, player: Player, name: str, pair: tuple, sources: list,
                  whole: AllOrNothing) -> bpy.types.Object:
    """Make the caustics of `pair`, a mirror and a lamp, play: existing ones, or new ones called `name`.

    The records contain the receivers' materials. The materials that add light are made anew.
    """
    # registered first, so that it runs last
    whole.after(forget_added_light, [material for obj in results_with(context, *pair)[:1]
                                     for material in obj.data.materials])
    obj = caustics_object(context, name, pair, sources, whole)
    made, unseen = stains(textured(pair[0]), whole), not all(source.visible_camera for source in sources)
    materials = [adds_light(material_of(*entry), made, whole, unseen)[0]
                 for entry in player.materials or [("", "")]]
    show_frames(obj, player, materials, whole)
    obj.reflection_mesh.faces = 0
    return obj
