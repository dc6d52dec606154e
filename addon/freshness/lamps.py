"""Digests of what shines on a scene: its lamps and its world."""
from __future__ import annotations

from hashlib import blake2b

import bpy
import numpy as np

from ..illumination import is_glint
from ..reading import rendered_in
from .materials import SIZE, content_of_data, made_of

# properties of lamps and worlds that their light depends on, besides nodes
VALUES = ("type", "color", "energy", "exposure", "temperature", "use_temperature", "normalize", "shadow_soft_size",
          "use_soft_falloff", "spot_size", "spot_blend", "angle", "shape", "size", "size_y", "spread")
# further properties that matter for Cycles' renders
OF_LAMPS, OF_WORLDS = ("cast_shadow", "is_portal", "max_bounces", "is_caustics_light"), ("max_bounces",
                                                                                       "is_caustics_light")
RAYS = ("camera", "diffuse", "glossy", "transmission", "scatter", "shadow")


def lamp_content(lamp: bpy.types.Light) -> bytes:
    """Return a digest of all that renders show of a lamp's data, with the present values of what is animated."""
    return content_of_data(lamp, [name for name in (*VALUES, "use_shadow") if hasattr(lamp, name)], OF_LAMPS)


def world_content(world: bpy.types.World | None) -> bytes:
    """Return the content of a world, as `lamp_content` does of a lamp."""
    if world is None:
        return b"none"
    rays = getattr(world, "cycles_visibility", None)
    seen = repr([getattr(rays, name, None) for name in RAYS]).encode()
    return seen + content_of_data(world, [name for name in VALUES if hasattr(world, name)], OF_WORLDS)


def lamps_of(context: bpy.types.Context) -> str:
    """Return a digest of the lamps in a view layer's renders with their transforms, and of the world."""
    lamps = [obj for obj in filter(rendered_in(context.view_layer), context.view_layer.objects)
             if obj.type == "LIGHT" and not is_glint(obj)]
    told = sorted(np.array(lamp.matrix_world, dtype=np.float32).tobytes() + _made_of(lamp.data) for lamp in lamps)
    world = context.scene.world
    return blake2b(b"".join(told) + (b"" if world is None else _made_of(world)), digest_size=SIZE).hexdigest()


def _made_of(data: bpy.types.Light | bpy.types.World) -> bytes:
    return repr(list(made_of(data, [name for name in VALUES if hasattr(data, name)]))).encode()
