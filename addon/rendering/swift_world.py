"""Worlds whose light Cycles is soon ready to sample: it maps where they are bright for each render and bake anew."""
from __future__ import annotations

from contextlib import ExitStack

import bpy

from .. import compat
from ..reading import all_nodes

PLAIN = 512     # columns of the map of what has no image
FINE = 1024     # of what has one: a pixel is less than the sun is wide, so that its middle lies in the sun somewhere


def put_swift_world(scene: bpy.types.Scene, back: ExitStack) -> None:
    """Let a temporary scene have its world as `swiftly_sampled`, as long as the stack is open."""
    if scene.world is None:
        return
    world = swiftly_sampled(scene.world)
    if world is not scene.world:
        back.callback(bpy.data.worlds.remove, world)
        scene.world = world


def swiftly_sampled(world: bpy.types.World) -> bpy.types.World:
    """The world, or a copy with a smaller map than Cycles would choose.

    The map tells where to look for light, and not what is there: a coarser one changes no more than noise. Cycles' own
    is as large as the largest image, and 2048 x 1024 without one, which takes longer than the bake of a small object.
    """
    if not compat.uses_nodes(world) or getattr(world, "cycles", None) is None:
        return world
    nodes = list(all_nodes(world.node_tree))
    images = [node.image for node in nodes if node.type == "TEX_ENVIRONMENT" and node.image is not None]
    # Cycles knows by itself how much of a map a sky needs, and looks for its sun apart from that
    if (world.cycles.sampling_method != "AUTOMATIC" or any(node.type == "TEX_SKY" for node in nodes)
            or images and max(image.size[0] for image in images) <= FINE):
        return world
    copy = world.copy()
    copy.cycles.sampling_method = "MANUAL"
    copy.cycles.sample_map_resolution = FINE if images or any(node.type == "TEX_IMAGE" for node in nodes) else PLAIN
    return copy
