"""Which materials let no light through: what lies behind them whole is not seen, in Cycles as in any engine."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import all_nodes, shown_output
from .shader_graph import surface_shaders

OPEN_SHADERS = {"BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION", "HOLDOUT"}
# sockets of a Principled BSDF, and the value at which each lets nothing through
CLOSED = {"Alpha": 1.0, "Transmission Weight": 0.0}
WHITE = 0.9  # of each colour, what clear glass lets through at least


def is_opaque(material: bpy.types.Material | None) -> bool:
    """Whether no light goes through `material`, as far as its nodes tell, whether they reach its output or not."""
    if material is None or not compat.uses_nodes(material):
        return True
    return not (is_fog(material) or any(_lets_through(node) for node in all_nodes(material.node_tree)))


def fog_of(owner: bpy.types.Material | bpy.types.World | None) -> bpy.types.NodeSocket | None:
    """The socket into which a material's, or a world's, nodes put fog or what else fills a volume; None where there is
    nothing."""
    output = shown_output(owner.node_tree) if owner is not None and compat.uses_nodes(owner) else None
    socket = None if output is None else output.inputs["Volume"]
    return socket if socket is not None and socket.is_linked else None


def is_fog(material: bpy.types.Material | None) -> bool:
    """Whether `material` fills what it bounds and is no surface: light goes straight through its faces."""
    socket = fog_of(material)
    return socket is not None and not socket.node.inputs["Surface"].is_linked


def _lets_through(node: bpy.types.Node) -> bool:
    if node.type != "BSDF_PRINCIPLED":
        return node.type in OPEN_SHADERS
    sockets = {name: node.inputs.get(name) for name in CLOSED}
    return any(socket is not None and (socket.is_linked or socket.default_value != CLOSED[name])
               for name, socket in sockets.items())


def is_clear(material: bpy.types.Material | None) -> bool:
    """Whether `material` sends nothing of light back but what it mirrors, and lets all else through: glass, what is
    transparent, and mixes of these."""
    if material is None or not compat.uses_nodes(material):
        return False
    shaders = surface_shaders(material.node_tree)
    return bool(shaders) and all(map(_lets_all_through, shaders))


def is_colourless(material: bpy.types.Material | None) -> bool:
    """Return True for a clear material that changes no colour, so that nobody misses it where something covers it."""
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
