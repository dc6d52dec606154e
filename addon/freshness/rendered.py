"""Digests of all that renders show, object by object: where it stands, its geometry, its ray visibility, its materials.

They are taken once after each change that Blender tells of, and serve all results.
"""
from __future__ import annotations

from collections.abc import Iterable
from hashlib import blake2b
from typing import NamedTuple

import bpy
import numpy as np

from ..illumination import is_glint
from ..reading import LINKS, is_rendered, is_result, link_state, rendered_in
from . import digests
from .lamps import lamp_content, world_content
from .materials import SIZE, content_of

# properties of objects that affect renders, besides geometry and materials
FLAGS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow",
         "is_holdout", "is_shadow_catcher", "pass_index")
CYCLES_FLAGS = ("shadow_terminator_offset", "shadow_terminator_geometry_offset", "is_caustics_caster",
                "is_caustics_receiver", "ao_distance", "use_adaptive_subdivision", "dicing_rate", "is_portal")
# properties of modifiers that may give renders other meshes than viewports
RENDER_LEVELS = ("show_render", "render_levels", "render_resolution")
PARTICLES = ("count", "child_type", "rendered_child_count", "child_percent", "render_type", "particle_size",
             "render_step", "child_length", "child_radius", "hair_length", "root_radius", "tip_radius", "radius_scale")
# object types that engines draw as generated meshes, or not at all
UNDRAWN = {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "CURVE", "SURFACE", "FONT", "META", "LIGHT_PROBE"}

_told: dict[tuple, Rendered] = {}
_flags: dict[int, bytes] = {}


class Rendered(NamedTuple):
    """Digests by `session_uid`: of objects with what they instance, and of the materials that each shows; and one of
    the lamps and the world."""

    objects: dict[int, bytes]
    materials: dict[int, bytes]
    lamps: str


def rendered(context: bpy.types.Context) -> Rendered:
    """Return the digests of what renders of the view layer show now."""
    key = digests.tick(), context.scene.session_uid, context.view_layer.name
    if key not in _told:
        if not any(known[1:] == key[1:] for known in _told):
            # flags of another view layer
            forget_rendered()
        _told.clear()
        _told[key] = _taken(context)
    return _told[key]


def forget_rendered(changed: Iterable[bpy.types.ID] | None = None) -> None:
    """Read the flags of objects anew when they are asked for next.

    Of those that have `changed`; of all where a scene or a collection has, whose layers have flags too, or for None.
    """
    if changed is None:
        _flags.clear()
        return
    for item in changed:
        if isinstance(item, bpy.types.Scene | bpy.types.Collection):
            _flags.clear()
        elif isinstance(item, bpy.types.Object):
            _flags.pop(item.original.session_uid, None)


def _taken(context: bpy.types.Context) -> Rendered:
    depsgraph, layer = context.evaluated_depsgraph_get(), context.view_layer
    in_renders, given = rendered_in(layer), {}
    counts: dict[bpy.types.Object, bool] = {}  # by owner: True if it is an input of light and rendered
    objects: dict[int, list] = {}
    materials: dict[int, list] = {}
    lamps: list = []
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        if evaluated.type in UNDRAWN or not (evaluated.type == "LIGHT" or instance.show_self):
            continue
        original = evaluated.original
        parent = instance.parent if instance.is_instance else None
        owner = original if parent is None else parent.original
        if owner not in counts:
            counts[owner] = in_renders(owner) and not is_result(owner) and not is_glint(owner)
        # curves and the like are instances of themselves
        if not counts[owner] or (original != owner and not is_rendered(instance, given)):
            continue
        place = np.array(instance.matrix_world, dtype=np.float32).tobytes() + _flags_of(original, layer)
        if original != owner:
            place += _flags_of(owner, layer)
        if evaluated.type == "LIGHT":
            lamps.append(place + lamp_content(original.data))
            continue
        uid = owner.session_uid
        objects.setdefault(uid, []).append(place + digests.geometry_of(evaluated, parent))
        materials.setdefault(uid, []).append(b"".join(
            content_of(slot.material.original) if slot.material else b"none" for slot in evaluated.material_slots))
    told = sorted(lamps) + [world_content(context.scene.world)]
    return Rendered({uid: _digest(parts) for uid, parts in objects.items()},
                    {uid: _digest(parts) for uid, parts in materials.items()}, _digest(told).hex())


digests.listen(forget_rendered)


def _digest(parts: list[bytes]) -> bytes:
    told = blake2b(digest_size=SIZE)
    for part in sorted(parts):
        told.update(len(part).to_bytes(4, "big") + part)
    return told.digest()


def _flags_of(obj: bpy.types.Object, layer: bpy.types.ViewLayer) -> bytes:
    """Return a digest of an object's properties that affect renders, besides geometry and materials."""
    if obj.session_uid not in _flags:
        _flags[obj.session_uid] = blake2b(repr(_read(obj, layer)).encode(), digest_size=SIZE).digest()
    return _flags[obj.session_uid]


def _read(obj: bpy.types.Object, layer: bpy.types.ViewLayer) -> list:
    """Return the values of flags, ray visibility and links. A mirror that is a window counts as visible."""
    known = [getattr(obj, name) for name in FLAGS] + list(obj.color)
    known += [obj.visible_camera or obj.reflection_mesh.camera_hidden, obj.holdout_get(view_layer=layer),
              obj.indirect_only_get(view_layer=layer)]
    known += [getattr(obj.cycles, name) for name in CYCLES_FLAGS if hasattr(getattr(obj, "cycles", None), name)]
    known += [[getattr(modifier, name, None) for name in RENDER_LEVELS] for modifier in obj.modifiers]
    known += [[getattr(system.settings, name, None) for name in PARTICLES] + [system.seed]
              for system in obj.particle_systems]
    for collection in (getattr(obj.light_linking, name) for name in LINKS):
        known.append(None if collection is None else sorted(
            (member.name_full, link_state(collection, member)) for member in collection.all_objects))
    return known
