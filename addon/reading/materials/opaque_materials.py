"""Find materials that transmit no light: objects behind them are hidden."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import all_nodes, shown_output
from .shader_graph import surface_shaders

OPEN_SHADERS = {"BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION", "HOLDOUT"}
# sockets of a Principled BSDF, and the value at which each transmits nothing
CLOSED = {"Alpha": 1.0, "Transmission Weight": 0.0}
WHITE = 0.9  # lowest transmitted share of each colour channel of untinted glass


def is_opaque(material: bpy.types.Material | None) -> bool:
    """Return True if no node of `material` transmits light. Nodes that are not connected to the output count too."""
    if material is None or not compat.uses_nodes(material):
        return True
    return not (is_fog(material) or any(_lets_through(node) for node in all_nodes(material.node_tree)))


def fog_of(owner: bpy.types.Material | bpy.types.World | None) -> bpy.types.NodeSocket | None:
    """Return the socket that is linked to the Volume input of a material's or a world's output; None if nothing is
    linked.
    """
    output = shown_output(owner.node_tree) if owner is not None and compat.uses_nodes(owner) else None
    socket = None if output is None else output.inputs["Volume"]
    return socket if socket is not None and socket.is_linked else None


def is_fog(material: bpy.types.Material | None) -> bool:
    """Return True if `material` has a volume and no surface: light passes straight through its faces."""
    socket = fog_of(material)
    return socket is not None and not socket.node.inputs["Surface"].is_linked


def _lets_through(node: bpy.types.Node) -> bool:
    if node.type != "BSDF_PRINCIPLED":
        return node.type in OPEN_SHADERS
    sockets = {name: node.inputs.get(name) for name in CLOSED}
    return any(socket is not None and (socket.is_linked or socket.default_value != CLOSED[name])
               for name, socket in sockets.items())


def is_clear(material: bpy.types.Material | None) -> bool:
    """Return True if `material` only reflects specularly or transmits: glass, transparency, and mixes of these."""
    if material is None or not compat.uses_nodes(material):
        return False
    shaders = surface_shaders(material.node_tree)
    return bool(shaders) and all(map(_lets_all_through, shaders))


def is_colourless(material: bpy.types.Material | None) -> bool:
    """Return True for a clear material that does not tint light. If something covers it, nobody misses it."""
    return is_fog(material) or is_clear(material) and not any(map(_is_tinted, surface_shaders(material.node_tree)))


def _is_tinted(shader: bpy.types.Node) -> bool:
    colour = shader.inputs.get("Color") or shader.inputs["Base Color"]
    return colour.is_linked or min(colour.default_value[:3]) < WHITE


def _lets_all_through(shader: bpy.types.Node) -> bool:
    if shader.type != "BSDF_PRINCIPLED":
        return shader.type in OPEN_SHADERS - {"HOLDOUT"}
    metal, glass, alpha = (shader.inputs[name] for name in ("Metallic", "Transmission Weight", "Alpha"))
    clear = not glass.is_linked and glass.default_value == 1.0 and not metal.is_linked and metal.default_value == 0.0
    return clear or (not alpha.is_linked and alpha.default_value == 0.0)
