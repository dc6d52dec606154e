"""Digests of what objects show: where they and their instances stand, and their evaluated geometry, hashed once.

Geometry is hashed again only where Blender has told that it may be another; `tick` counts what may have changed
anything.
"""
from __future__ import annotations

from collections.abc import Callable
from hashlib import blake2b

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..reading import drawn_meshes, is_rendered, rendered_in
from ..registration import Handlers
from .materials import forget_materials

# property, number of components and dtype to read an attribute, by its type
LAYOUTS = {"FLOAT": ("value", 1, np.float32), "FLOAT_VECTOR": ("vector", 3, np.float32),
           "FLOAT2": ("vector", 2, np.float32), "FLOAT_COLOR": ("color", 4, np.float32),
           "BYTE_COLOR": ("color", 4, np.float32), "INT": ("value", 1, np.int32), "BOOLEAN": ("value", 1, bool)}
CORNERS = ".corner_vert"  # the only hidden attribute that belongs to the shape; the others are selections
VOLUME = ("filepath", "is_sequence", "frame_start", "frame_offset", "frame_duration", "sequence_mode")
SIZE = 12  # bytes of a digest

_geometry: dict[tuple, bytes] = {}
_ticks = [0]
_listeners: list[Callable[[list | None], None]] = [forget_materials]


def tick() -> int:
    """Return a number that changes whenever anything may have changed."""
    return _ticks[0]


def listen(forget_them: Callable[[list | None], None]) -> None:
    """Call a function with the data that has changed whenever Blender tells of some, or None where that may be any."""
    _listeners.append(forget_them)


def forget(session_uid: int | None = None) -> None:
    """Hash the geometry of an object, or of all objects, again when it is needed next."""
    for key in [key for key in _geometry if session_uid is None or session_uid in key[:2]]:
        del _geometry[key]


def digest_of(depsgraph: bpy.types.Depsgraph, objects: list) -> str:
    """Return one digest of the shape and place of `objects` and of their instances. Objects hidden in viewports are
    ignored.
    """
    return _digest(depsgraph, {obj: index for index, obj in enumerate(objects)}, lambda instance: True)


def digest_of_shown(depsgraph: bpy.types.Depsgraph, objects: list, unmirrored: bool = False) -> str:
    """Return `digest_of` for the visible parts in mirrors: without objects that renders or glossy rays ignore. Include
    those hidden from glossy rays if `unmirrored` is set; caustics need them.
    """
    rendered = rendered_in(depsgraph.view_layer)
    owner_of = {obj: index for index, obj in enumerate(objects) if (unmirrored or obj.visible_glossy) and rendered(obj)}
    given: dict = {}
    return _digest(depsgraph, owner_of, lambda instance: not instance.is_instance or (
        is_rendered(instance, given) and (unmirrored or instance.object.original.visible_glossy)))


def _digest(depsgraph: bpy.types.Depsgraph, owner_of: dict, counts: Callable) -> str:
    known = []
    for instance in drawn_meshes(depsgraph):
        evaluated = instance.object
        parent = instance.parent.original if instance.is_instance else None
        owner = owner_of.get(evaluated.original if parent is None else parent)
        if owner is None or not counts(instance):
            continue
        matrix = np.array(instance.matrix_world, dtype=np.float32)
        known.append(owner.to_bytes(4, "big") + matrix.tobytes() + geometry_of(evaluated, parent))
    return blake2b(b"".join(sorted(known)), digest_size=SIZE).hexdigest()


def geometry_of(evaluated: bpy.types.Object, parent: bpy.types.Object | None) -> bytes:
    """Return a digest of the shape and the layers of an evaluated object, which is an instance of `parent` or None."""
    data = evaluated.data
    key = (evaluated.original.session_uid, parent.original.session_uid if parent else 0, data.name if data else "")
    if key not in _geometry:
        _geometry[key] = _hashed(evaluated) if evaluated.type == "MESH" else _hashed_other(data)
    return _geometry[key]


def _hashed_other(data: bpy.types.ID | None) -> bytes:
    """Return a digest of hair curves and points by their attributes, and of a volume by its file and its frame."""
    told = blake2b(digest_size=SIZE)
    for attribute in sorted(getattr(data, "attributes", ()), key=lambda attribute: attribute.name):
        if attribute.data_type in LAYOUTS:
            told.update(attribute.name.encode() + _values(attribute.data, *LAYOUTS[attribute.data_type]))
    told.update(repr([getattr(data, name, None) for name in VOLUME]).encode())
    grids = getattr(data, "grids", None)
    told.update(repr(None if grids is None else (grids.frame, [grid.name for grid in grids])).encode())
    return told.digest()


def _hashed(obj: bpy.types.Object) -> bytes:
    """Return a digest (BLAKE2b) of the mesh of an evaluated object: its topology, attributes and custom normals.

    Attributes are, for example, positions, UV maps, colours and material indices. Hidden ones, such as selections, and
    those of types that are not in `LAYOUTS` are ignored.
    """
    mesh, told = obj.data, blake2b(digest_size=SIZE)
    told.update(np.array((len(mesh.vertices), len(mesh.polygons)), dtype=np.int64).tobytes())
    told.update(_values(mesh.polygons, "loop_start", 1, np.int32))
    for attribute in sorted(mesh.attributes, key=lambda attribute: attribute.name):
        if attribute.data_type in LAYOUTS and (not attribute.name.startswith(".") or attribute.name == CORNERS):
            told.update(attribute.name.encode())
            told.update(_values(attribute.data, *LAYOUTS[attribute.data_type]))
    if mesh.has_custom_normals:
        told.update(_values(mesh.corner_normals, "vector", 3, np.float32))
    return told.digest()


def _values(data, name: str, width: int, dtype) -> bytes:
    array = np.empty(width * len(data), dtype=dtype)
    data.foreach_get(name, array)
    return array.tobytes()


@persistent
def _after_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # a render's depsgraph tells of nothing that has happened in the file
    if depsgraph.mode != "VIEWPORT":
        return
    _ticks[0] += 1
    _tell([update.id for update in depsgraph.updates])
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object):
            forget(update.id.original.session_uid)


@persistent
def _after_all(*_) -> None:
    """After whatever may have exchanged everything."""
    _ticks[0] += 1
    forget()
    _tell(None)


def _tell(changed: list | None) -> None:
    for forget_them in _listeners:
        forget_them(changed)


HANDLERS = Handlers((_after_change, "depsgraph_update_post", "frame_change_post"),
                    (_after_all, "undo_post", "redo_post", "load_post"))
register = HANDLERS.register


def unregister() -> None:
    HANDLERS.unregister()
    forget()
    _tell(None)
