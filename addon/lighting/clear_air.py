"""Clear the world's fog where light paths have not yet reached the user's scene."""
from __future__ import annotations

from contextlib import ExitStack

import bpy

from ..reading import fog_of
from ..writing.nodes.shader_builder import ShaderBuilder


def clear_air(scene: bpy.types.Scene, back: ExitStack) -> None:
    """Give a temporary scene a world without fog before the first portal that a ray passes, until the stack is closed.

    From there on fog counts: between the mirror and the source if a path begins at the mirror, and around the source.
    """
    if fog_of(scene.world) is None:
        return
    world = scene.world.copy()
    back.callback(bpy.data.worlds.remove, world)
    scene.world = world
    socket, build = fog_of(world), ShaderBuilder(world.node_tree)
    # a portal counts as a transparent surface
    before = build.calculated("LESS_THAN", build.add("ShaderNodeLightPath").outputs["Transparent Depth"], 0.5)
    build.feed(build.mixed(before, socket.links[0].from_socket, None), socket)
