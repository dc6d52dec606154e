"""What an artist may have done to a lit scene besides: mirrors that are changed, turned over or carried by others,
skies from pictures, views of other colours, lamps of other shapes."""
from __future__ import annotations

from collections.abc import Callable, Mapping

import bpy
import numpy as np

from tests.fuzz.blender.lit_materials import node
from tests.fuzz.blender.scene_shapes import chosen


def varied(rng: np.random.Generator, mirror: bpy.types.Object, modifiers: Mapping[str, Callable]) -> list[str]:
    """Change a scene and its first mirror in some ways; what has been done."""
    done = []
    if rng.random() < 0.25:
        done.append(modifiers[chosen(rng, list(modifiers))](mirror) + " mirror")
    if rng.random() < 0.2:
        mirror.scale = rng.uniform(0.7, 1.2, 3) * (-1.0, 1.0, 1.0)
        done.append("mirror turned over")
    if rng.random() < 0.15:
        done.append(_carried(rng, mirror))
    if rng.random() < 0.4:
        done.append(_view(rng))
    if rng.random() < 0.2:
        done.append(_sky(rng))
    done += [_shaped(rng, lamp.data) for lamp in bpy.context.scene.objects if lamp.type == "LIGHT"
             and rng.random() < 0.3]
    return [one for one in done if one]


def _carried(rng: np.random.Generator, mirror: bpy.types.Object) -> str:
    carrier = bpy.data.objects.new("Carrier", None)
    carrier.location, carrier.scale = rng.uniform(-0.2, 0.2, 3).tolist(), rng.uniform(0.8, 1.2, 3).tolist()
    carrier.rotation_euler = rng.uniform(-0.15, 0.15, 3).tolist()
    bpy.context.scene.collection.objects.link(carrier)
    mirror.parent = carrier
    return "carried mirror"


def _view(rng: np.random.Generator) -> str:
    view = bpy.context.scene.view_settings
    view.view_transform, view.exposure = chosen(rng, ["AgX", "Filmic", "Standard"]), float(rng.uniform(-1.5, 1.0))
    return f"{view.view_transform} at {view.exposure:.1f}"


def _sky(rng: np.random.Generator) -> str:
    """A picture of few pixels around it all, one of them a bright window."""
    image = bpy.data.images.new("Sky", 16, 8, float_buffer=True)
    pixels = np.ones((8, 16, 4), dtype=np.float32)
    pixels[..., :3] = rng.uniform(0.05, 0.6, (8, 16, 3))
    pixels[5, int(rng.integers(16)), :3] = 6.0
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    world = bpy.context.scene.world = bpy.data.worlds.new("Sky")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    background = next(one for one in world.node_tree.nodes if one.type == "BACKGROUND")
    picture = node(world.node_tree, "TexEnvironment")
    picture.image = image
    world.node_tree.links.new(picture.outputs[0], background.inputs["Color"])
    return "a sky from a picture"


def _shaped(rng: np.random.Generator, lamp: bpy.types.Light) -> str:
    if lamp.type == "AREA":
        lamp.shape, lamp.size_y = chosen(rng, ["RECTANGLE", "DISK", "ELLIPSE"]), float(rng.uniform(0.3, 1.5))
        return f"{lamp.shape.lower()} lamp"
    if lamp.type == "SPOT":
        lamp.spot_blend = float(rng.uniform(0.0, 1.0))
        return "soft cone"
    if lamp.type == "SUN":
        lamp.angle = chosen(rng, [0.0, 0.3])
        return "another sun"
    lamp.use_soft_falloff = False
    return "hard falloff"
