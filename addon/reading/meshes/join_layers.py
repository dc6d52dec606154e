"""Join the UV maps, colours and attributes of several meshes into as few layers as there are names."""
from __future__ import annotations

import itertools

import numpy as np

from .placed_values import Part, PlacedValues
from .read_layers import Layers
from .read_meshes import Placed


def join_layers(placed: list[Placed]) -> Layers:
    """Join the layers of the meshes, with values (m, 3, c) at the corners of all triangles.

    The active layer of the result takes the active layer of each mesh. If another mesh has a layer of that name that is
    not active, materials may read both: then the active layer gets a name of its own.
    """
    active_uv, active_colour = (_active(placed, *kind) for kind in (("uv_maps", "active_uv"),
                                                                     ("colours", "active_colour")))
    return Layers(
        {name: _uv_map(placed, name, name == active_uv) for name in _names(placed, "uv_maps", active_uv)},
        {name: _colour(placed, name, name == active_colour) for name in _names(placed, "colours", active_colour)},
        {name: _numbers(placed, name) for name in _names(placed, "numbers")}, active_uv, active_colour)


def _active(placed: list[Placed], kind: str, active: str) -> str:
    """Return the name of the joined active layer of a kind, "" if no mesh has one."""
    found = next((getattr(item.mesh, active) for item in placed if getattr(item.mesh, active)), "")
    if any(found in getattr(item.mesh, kind) and getattr(item.mesh, active) != found for item in placed):
        taken = {name for some in ("uv_maps", "colours", "numbers") for name in _names(placed, some)}
        others = (f"{found} Active {number}" for number in itertools.count(1))
        found = next(name for name in others if name not in taken)
    return found


def _names(placed: list[Placed], kind: str, active: str = "") -> list:
    """Return the names of all layers of a kind, including the active one."""
    names = dict.fromkeys(name for item in placed for name in getattr(item.mesh, kind))
    return list(names | {active: None} if active else names)


def _uv_map(placed: list[Placed], name: str, active: bool) -> PlacedValues:
    """Return the values (m, 3, 2) of a UV map; of each mesh's own active map if `active` is set. Meshes without the map
    get zeros.
    """
    def values(part: Part) -> np.ndarray | float:
        known = part.mesh.uv_maps.get(part.mesh.active_uv if active else name)
        return 0.0 if known is None else known[part.corners]
    return PlacedValues(placed, (3, 2), np.float32, values)


def _colour(placed: list[Placed], name: str, active: bool) -> tuple:
    """Return the type and the values (m, 3, 4) of a colour layer, see `_uv_map`. Mixed types become float colours."""
    def entry(mesh) -> tuple:
        return mesh.colours.get(mesh.active_colour if active else name) or (None, None)

    def values(part: Part) -> np.ndarray | float:
        known = entry(part.mesh)[1]
        return 0.0 if known is None else known[part.corners]
    types = {entry(item.mesh)[0] for item in placed}
    kind = "BYTE_COLOR" if types <= {"BYTE_COLOR", None} else "FLOAT_COLOR"
    return kind, PlacedValues(placed, (3, 4), np.float32, values)


def _numbers(placed: list[Placed], name: str) -> tuple:
    """Return the type and the values (m, 3, c) of an attribute. Meshes without it get zeros, as in the engines. Mixed
    types become vectors; a single number fills all components.
    """
    entries = [item.mesh.numbers.get(name) for item in placed]
    kind = "FLOAT" if all(entry is None or entry[0] == "FLOAT" for entry in entries) else "FLOAT_VECTOR"

    def values(part: Part) -> np.ndarray | float:
        entry = part.mesh.numbers.get(name)
        return 0.0 if entry is None else entry[1][part.corners]
    return kind, PlacedValues(placed, (3, 1 if kind == "FLOAT" else 3), np.float32, values)
