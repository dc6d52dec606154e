"""Record the inputs of caustics, and find the inputs that have changed since."""
from __future__ import annotations

import json
from hashlib import blake2b
from typing import NamedTuple

import bpy
import numpy as np

from ..frames import plays
from ..illumination import blocking, is_glint, light_of_nodes, radiance_of
from ..reading import Participants, seen_in
from . import digests
from .answers import answer
from .made_from import COARSE, LONGEST, settings_of
from .materials import colours_of

NUMBERS = {"FLOAT", "INT", "BOOLEAN", "ENUM"}
ASKED = ("tolerance", "depth")  # settings that light depends on


class LightOrigin(NamedTuple):
    """The inputs of caustics: digests of the mirror, of the lamp, of the lit objects and of the occluders around, with
    their materials, and the settings.
    """

    mirror: str
    lamp: str
    lit: str
    around: str
    settings: dict


def light_record(context: bpy.types.Context, mirror: bpy.types.Object, lamp: bpy.types.Object, sources: list) -> str:
    """Return the text that caustics of a mirror and a lamp on `sources` store if they are made now."""
    return json.dumps(_origin(context, mirror, lamp, sources)._asdict())


def why_light_is_stale(context: bpy.types.Context, light: bpy.types.Object) -> str:
    """Return what has changed since caustics were made, in a few words, like `why_stale` for a reflection."""
    record = light.reflection_mesh
    if not record.made_from or plays(light):
        return ""
    if any(part is None or not part.users_scene for part in (record.mirror, record.lamp)):
        return "its mirror or its lamp was removed: clear it"
    key = record.made_from, *_settings(context, record.mirror).values()
    return answer(_changed, context, light, key)


def lamp_numbers(depsgraph: bpy.types.Depsgraph, lamp: bpy.types.Object) -> tuple:
    """Return the transform of a lamp, its visibility in mirrors and its properties as numbers. For a mesh, return a
    digest of its shape and its emission.
    """
    if lamp.type != "LIGHT":
        return digests.digest_of(depsgraph, [lamp]), lamp.visible_glossy, *(radiance_of(slot.material).tobytes()
                                                       for slot in lamp.material_slots)
    evaluated = lamp.evaluated_get(depsgraph)
    data = evaluated.data
    # skip the properties of all data-blocks: they do not affect light and may differ between sessions
    values = (getattr(data, prop.identifier) for prop in data.bl_rna.properties if prop.type in NUMBERS
              and prop.identifier != "use_nodes" and prop.identifier not in bpy.types.ID.bl_rna.properties)
    return (np.array(evaluated.matrix_world, dtype=np.float32).tobytes(), lamp.visible_glossy,
            light_of_nodes(data)[0].tobytes(),
            *(tuple(value) if hasattr(value, "__len__") and not isinstance(value, str | set) else str(value)
              for value in values))


def _changed(context: bpy.types.Context, light: bpy.types.Object) -> str:
    """Return the first input of caustics that has changed, in a few words."""
    record = light.reflection_mesh
    if record.made_from == COARSE:
        return "Live was stopped before it was exact"
    made, sources = _read(record.made_from), [source.object for source in record.sources]
    if made is None:
        return ""
    if None in sources:
        return "an object was removed"
    return _difference(made, _origin(context, record.mirror, record.lamp, sources))


def _difference(made: LightOrigin, now: LightOrigin) -> str:
    """Return the difference between two records in a few words; "" if there is none."""
    if made.mirror != now.mirror:
        return "the mirror has changed"
    if made.lamp != now.lamp:
        return "the lamp has changed"
    if made.lit != now.lit:
        return "what is lit has changed"
    if made.around != now.around:
        return "what stands in the light's way has changed"
    return "the settings have changed" if made.settings != now.settings else ""


def _origin(context: bpy.types.Context, mirror: bpy.types.Object, lamp: bpy.types.Object, sources: list) -> LightOrigin:
    depsgraph = context.evaluated_depsgraph_get()
    # other mirrors among it, be they made together with this one or not
    around = [obj for obj in blocking(context, Participants([mirror], sources, []))
              if obj != lamp and not is_glint(obj)]
    numbers = blake2b(repr(lamp_numbers(depsgraph, lamp)).encode(), digest_size=digests.SIZE).hexdigest()
    # hidden lamps emit no light
    numbers += "" if seen_in(context)(lamp) else " hidden"
    return LightOrigin(digests.digest_of(depsgraph, [mirror]) + colours_of([mirror]), numbers,
                       digests.digest_of_shown(depsgraph, sources, unmirrored=True) + colours_of(sources)
                       + _unseen(sources),
                       digests.digest_of(depsgraph, around), _settings(context, mirror))


def _unseen(sources: list) -> str:
    """Return a text with the indices of lit objects that are hidden from the camera; "" if there are none."""
    unseen = [number for number, obj in enumerate(sources) if obj is not None and not obj.visible_camera]
    return f" unseen {unseen}" if unseen else ""


def _settings(context: bpy.types.Context, mirror: bpy.types.Object) -> dict:
    return {name: value for name, value in settings_of(context.scene, mirror).items() if name in ASKED}


def _read(text: str) -> LightOrigin | None:
    """Return the inputs from a text of `light_record`; None for any other text."""
    if len(text) > LONGEST:
        return None
    try:
        return LightOrigin(**json.loads(text))
    except (ValueError, TypeError, RecursionError):
        return None
