"""Fog between the eye and the mirrors, left out of what they show: whatever the picture is shown through adds it again.

What mirrors show is seen through the fog before them in the picture of light as in every later render. There it counts,
here it must not: fog lets all light through on the way from the camera to the first surface that light does not pass
straight, and is on every other way what it is.
"""
from __future__ import annotations

from contextlib import ExitStack

import bpy

from ..reading import fog_of, is_fog
from ..rendering import OwnCollections
from ..writing.nodes.shader_builder import ShaderBuilder


def clear_air(scene: bpy.types.Scene, own: OwnCollections, objects: list, back: ExitStack) -> list:
    """Let a temporary scene have its world, and copies of its `objects` of fog, with clear air before the first surface
    that the camera sees, as long as the stack is open; return the copies."""
    if fog_of(scene.world) is not None:
        world = scene.world.copy()
        back.callback(bpy.data.worlds.remove, world)
        _clear(world)
        scene.world = world
    made: dict = {}
    copies = [own.copy_of(obj) for obj in objects]
    for slot in (slot for obj in copies for slot in obj.material_slots):
        if slot.material not in made:
            made[slot.material] = slot.material.copy()
            back.callback(bpy.data.materials.remove, made[slot.material])
            _clear(made[slot.material])
        material, slot.link = made[slot.material], "OBJECT"
        slot.material = material
    return copies


def is_of_fog(obj: bpy.types.Object) -> bool:
    """Whether an object is fog that can be cleared: that of instanced collections is theirs."""
    own = [slot.material for slot in obj.material_slots]
    return bool(own) and all(map(is_fog, own))


def _clear(owner: bpy.types.World | bpy.types.Material) -> None:
    socket, build = fog_of(owner), ShaderBuilder(owner.node_tree)
    way = build.add("ShaderNodeLightPath").outputs
    before = build.calculated("MULTIPLY", way["Is Camera Ray"],
                              build.calculated("LESS_THAN", way["Transparent Depth"], 0.5))
    build.feed(build.mixed(before, socket.links[0].from_socket, None), socket)
