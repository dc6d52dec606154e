"""What a texel holds from side to side, from bakes that each look at a part of it."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ...writing import UV_MAP

METALS, GLASSES = {"BSDF_GLOSSY", "BSDF_METALLIC"}, {"BSDF_GLASS", "BSDF_REFRACTION"}
DULL = 0.5        # roughness of a Principled BSDF from which on it hardly shows where it is looked at from
UNTOUCHED = -1.0  # of a texel that nothing was baked into; light is never below zero


def has_pattern(material: bpy.types.Material | None) -> bool:
    """Whether a material has textures, or anything else that goes by their coordinates."""
    return any(node.type == "UVMAP" or node.type.startswith("TEX_") for node in _nodes(material))


def is_glossy(material: bpy.types.Material | None) -> bool:
    """Whether a material looks otherwise from elsewhere, to an eye that sees no measurements."""
    return any(node.type in METALS | GLASSES or node.type == "BSDF_PRINCIPLED" and (
        _exceeds(node.inputs["Metallic"], 0.0) or _exceeds(node.inputs["Transmission Weight"], 0.0)
        or node.inputs["Roughness"].is_linked or node.inputs["Roughness"].default_value < DULL)
        for node in _nodes(material))


def _exceeds(socket: bpy.types.NodeSocket, value: float) -> bool:
    return socket.is_linked or socket.default_value > value


def _nodes(holder: bpy.types.Material | bpy.types.ShaderNodeTree | None) -> list[bpy.types.Node]:
    """The nodes of a material, those in groups of nodes among them."""
    tree = getattr(holder, "node_tree", holder)
    own = [] if tree is None else list(tree.nodes)
    return own + [inner for node in own if node.type == "GROUP" for inner in _nodes(node.node_tree)]


@contextmanager
def framed(objects: list, low: np.ndarray, size: np.ndarray) -> Iterator[None]:
    """Let the part of the picture of `objects` that begins at `low` (2,) and is of a `size` (2,), in parts of the
    whole, be all that is baked of it."""
    kept = []
    for obj in objects:
        uv = np.empty((len(obj.data.loops), 2), dtype=np.float32)
        layer = obj.data.uv_layers[UV_MAP].uv
        layer.foreach_get("vector", uv.reshape(-1))
        layer.foreach_set("vector", ((uv - low) / size).astype(np.float32).reshape(-1))
        kept.append((obj, uv))
    try:
        yield
    finally:
        for obj, uv in kept:
            obj.data.uv_layers[UV_MAP].uv.foreach_set("vector", uv.reshape(-1))


def mean_of_what_is_known(pictures: list) -> np.ndarray:
    """The mean of pictures (height, width, 4), texel by texel, of those that know it."""
    mean = pictures[0].copy()
    count = (mean[..., 3] != UNTOUCHED).astype(np.float32)
    for picture in pictures[1:]:
        known = picture[..., 3] != UNTOUCHED
        count += known
        first, more = known & (count == 1.0), known & (count > 1.0)
        mean[first] = picture[first]
        mean[more] += (picture[more] - mean[more]) / count[more, None]
    return mean
