"""What the corners of several meshes show, one after the other, in as few layers as they have names."""
from __future__ import annotations

import numpy as np

from .read_layers import Layers
from .read_meshes import Placed


def join_layers(placed: list[Placed], corners: np.ndarray) -> Layers:
    """The layers of the meshes, each as often as it stands somewhere, at the joined `corners` (m, 3): values
    (m, 3, c)."""
    active_uv = next((item.mesh.active_uv for item in placed if item.mesh.active_uv), "")
    active_colour = next((item.mesh.active_colour for item in placed if item.mesh.active_colour), "")
    return Layers(
        {name: _uv_map(placed, corners, name, name == active_uv) for name in _names(placed, "uv_maps")},
        {name: _colour(placed, corners, name, name == active_colour) for name in _names(placed, "colours")},
        {name: _numbers(placed, corners, name) for name in _names(placed, "numbers")}, active_uv, active_colour)


def _names(placed: list[Placed], kind: str) -> list:
    return list(dict.fromkeys(name for item in placed for name in getattr(item.mesh, kind)))


def _uv_map(placed: list[Placed], corners: np.ndarray, name: str, active: bool) -> np.ndarray:
    """Values (m, 3, 2); a mesh without the active map shows its own active one, one without any other map zeros."""
    parts = []
    for item in placed:
        mesh = item.mesh
        values = mesh.uv_maps.get(name, mesh.uv_maps.get(mesh.active_uv) if active else None)
        values = np.zeros((mesh.corner_count, 2), np.float32) if values is None else values
        parts.append(np.tile(values, (len(item.owners), 1)))
    return np.concatenate(parts)[corners]


def _colour(placed: list[Placed], corners: np.ndarray, name: str, active: bool) -> tuple:
    """Type and values (m, 3, 4), as `_uv_map`; where meshes differ in type the colours are kept as floats."""
    parts, types = [], set()
    for item in placed:
        mesh = item.mesh
        entry = mesh.colours.get(name, mesh.colours.get(mesh.active_colour) if active else None)
        if entry is None:
            entry = (None, np.zeros((mesh.corner_count, 4), np.float32))
        types.add(entry[0])
        parts.append(np.tile(entry[1], (len(item.owners), 1)))
    kind = "BYTE_COLOR" if types <= {"BYTE_COLOR", None} else "FLOAT_COLOR"
    return kind, np.concatenate(parts)[corners]


def _numbers(placed: list[Placed], corners: np.ndarray, name: str) -> tuple:
    """Type and values (m, 3, c), zeros where a mesh has none, as engines have it; where meshes differ in type as
    vectors, of which a single number is each component."""
    entries = [item.mesh.numbers.get(name) for item in placed]
    kind = "FLOAT" if all(entry is None or entry[0] == "FLOAT" for entry in entries) else "FLOAT_VECTOR"
    width = 1 if kind == "FLOAT" else 3
    parts = [np.zeros((item.mesh.corner_count, width), np.float32) if entry is None
             else np.broadcast_to(entry[1], (item.mesh.corner_count, width)) for item, entry in zip(placed, entries)]
    return kind, np.concatenate([np.tile(part, (len(item.owners), 1)) for item, part in zip(placed, parts)])[corners]
