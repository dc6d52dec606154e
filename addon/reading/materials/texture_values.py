"""Values that nodes give to a socket, as samples: of images their texels, of textures without images an even spread.

Nodes are followed that make one value of others. What depends on the eye, the light, the mesh or the object is unknown.
A value is (n,) float64, or (n, 3) where it is a colour; n is 1 where it is the same everywhere.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from .image_samples import COUNT, is_read, samples_of
from .shader_graph import Groups, fed_by, outermost

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
STEPS = np.linspace(0.0, 1.0, 257)  # positions at which ramps and curves are sampled
# quasi-random numbers from 0 to 1; their median is that of noise
EVEN = (np.arange(COUNT) * 0.6180339887498949) % 1.0
PROCEDURAL = {"TEX_GRADIENT", "TEX_MAGIC", "TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_WHITE_NOISE"}
BINARY: dict[str, Callable] = {
    "ADD": np.add, "SUBTRACT": np.subtract, "MULTIPLY": np.multiply, "MINIMUM": np.minimum, "MAXIMUM": np.maximum,
    "DARKEN": np.minimum, "LIGHTEN": np.maximum, "LESS_THAN": np.less, "GREATER_THAN": np.greater,
    "DIVIDE": lambda one, other: np.where(other == 0.0, 0.0, one / np.where(other == 0.0, 1.0, other)),
    "POWER": lambda one, other: np.power(np.maximum(one, 0.0), other), "MIX": lambda one, other: other,
    "SCREEN": lambda one, other: 1.0 - (1.0 - one) * (1.0 - other)}
UNARY: dict[str, Callable] = {"SQRT": lambda one: np.sqrt(np.maximum(one, 0.0)), "ABSOLUTE": np.abs}


class Unknown(Exception):
    """The value depends on more than the material."""


class Unread(Unknown):
    """The value depends on an image that is not loaded."""


class Inputs:
    """Sample the values of a node's inputs, by name or index. Unloaded images are loaded if `read` is set, else they
    raise `Unread`.
    """

    def __init__(self, node: bpy.types.Node, groups: Groups = (), read: bool = True) -> None:
        self.node, self.groups, self.read = node, groups, read

    def __getitem__(self, which: str | int) -> np.ndarray:
        """Return the sampled values (n,) or (n, 3) of an input. Raise `Unknown` if the nodes do not determine them."""
        socket = self.node.inputs[which]
        source, inside = fed_by(socket, self.groups)
        if source is None:
            value = np.array(outermost(socket, self.groups)[0].default_value, dtype=np.float64)
            value = value[None, :3] if value.ndim else value[None]
        else:
            value = _of_output(source, Inputs(source.node, inside, self.read))
        return _grey(value) if socket.type in {"VALUE", "INT", "BOOLEAN"} else value

    def colour(self, which: str | int) -> np.ndarray:
        value = self[which]
        return value if value.ndim == 2 else np.repeat(value[:, None], 3, axis=1)


def _of_output(output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    """Return the sampled values of an output socket of a node.

    Raises
    ------
    Unknown
    """
    node = output.node
    if node.type in {"VALUE", "RGB"}:
        value = np.array(node.outputs[0].default_value, dtype=np.float64)
        return value[None, :3] if value.ndim else value[None]
    if node.type == "TEX_IMAGE":
        return _of_image(node, output, given.read)
    if node.type in PROCEDURAL:
        return EVEN
    rule = RULES.get(node.type)
    if rule is None:
        raise Unknown
    return rule(node, output, given)


def _of_image(node: bpy.types.Node, output: bpy.types.NodeSocket, read: bool) -> np.ndarray:
    if node.image is None:
        raise Unknown
    if not read and not is_read(node.image):
        raise Unread
    samples = samples_of(node.image)
    if samples is None:
        raise Unknown
    return samples[:, 3] if output.name == "Alpha" else samples[:, :3]


def _math(node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    if node.operation in UNARY:
        value = UNARY[node.operation](given[0])
    elif node.operation == "MULTIPLY_ADD":
        value = given[0] * given[1] + given[2]
    elif node.operation in BINARY:
        value = BINARY[node.operation](given[0], given[1]).astype(np.float64)
    else:
        raise Unknown
    return np.clip(value, 0.0, 1.0) if node.use_clamp else value


def _mix(node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    """Evaluate the Mix node or the older Mix RGB."""
    kind = getattr(node, "data_type", "RGBA")
    factor = np.clip(given[0], 0.0, 1.0)
    if kind == "FLOAT":
        return factor * given[3] + (1.0 - factor) * given[2]
    if kind != "RGBA" or node.blend_type not in BINARY:
        raise Unknown
    first, second = map(given.colour, (6, 7) if node.type == "MIX" else (1, 2))
    factor = factor[:, None]
    value = factor * BINARY[node.blend_type](first, second) + (1.0 - factor) * first
    clamp = node.clamp_result if node.type == "MIX" else node.use_clamp
    return np.clip(value, 0.0, 1.0) if clamp else value


def _ramp(node: bpy.types.Node, output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    table = np.array([tuple(node.color_ramp.evaluate(step)) for step in STEPS.tolist()])
    value = table[np.rint(np.clip(given[0], 0.0, 1.0) * (len(STEPS) - 1)).astype(int)]
    return value[:, 3] if output.name == "Alpha" else value[:, :3]


def _curves(node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    """Evaluate Float Curve or RGB Curves. The last of the RGB Curves applies to all three channels."""
    mapping = node.mapping
    tables = [np.array([mapping.evaluate(curve, step) for step in STEPS.tolist()]) for curve in mapping.curves]
    if node.type == "CURVE_FLOAT":
        value, factor, changed = given[1], given[0], np.interp(given[1], STEPS, tables[0])
    else:
        value, factor = given.colour(1), given[0][:, None]
        common = np.interp(value, STEPS, tables[3])
        changed = np.stack([np.interp(common[:, place], STEPS, tables[place]) for place in range(3)], axis=1)
    return factor * changed + (1.0 - factor) * value


def _map_range(node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    if node.data_type != "FLOAT" or node.interpolation_type != "LINEAR":
        raise Unknown
    low, high, first, second = (given[name] for name in ("From Min", "From Max", "To Min", "To Max"))
    share = BINARY["DIVIDE"](given[0] - low, high - low)
    return first + (second - first) * (np.clip(share, 0.0, 1.0) if node.clamp else share)


def _separate(node: bpy.types.Node, output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unknown
    return given.colour(0)[:, list(node.outputs).index(output)]


def _combine(node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unknown
    return np.stack(np.broadcast_arrays(*(given[place] for place in range(3))), axis=1)


def _invert(_node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    factor, value = given[0][:, None], given.colour(1)
    return factor * (1.0 - value) + (1.0 - factor) * value


def _contrast(_node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    value, bright, contrast = given.colour(0), given[1][:, None], given[2][:, None]
    return np.maximum((1.0 + contrast) * value + bright - 0.5 * contrast, 0.0)


def _hue(_node: bpy.types.Node, _output: bpy.types.NodeSocket, given: Inputs) -> np.ndarray:
    """Evaluate Hue/Saturation/Value for greys, which hue and saturation leave unchanged.

    Raises
    ------
    Unknown
        If a value is not grey.
    """
    value = given.colour("Color")
    if np.ptp(value, axis=1).max() > 1e-3:
        raise Unknown
    return value * (1.0 + given["Fac" if "Fac" in given.node.inputs else "Factor"] * (given["Value"] - 1.0))[:, None]


def _grey(value: np.ndarray) -> np.ndarray:
    return value @ LUMINANCE if value.ndim == 2 else value


RULES: dict[str, Callable[[bpy.types.Node, bpy.types.NodeSocket, Inputs], np.ndarray]] = {
    "MATH": _math, "MIX": _mix, "MIX_RGB": _mix, "VALTORGB": _ramp, "CURVE_RGB": _curves, "CURVE_FLOAT": _curves,
    "MAP_RANGE": _map_range, "SEPARATE_COLOR": _separate, "SEPRGB": _separate, "SEPXYZ": _separate,
    "COMBINE_COLOR": _combine, "COMBRGB": _combine, "COMBXYZ": _combine, "INVERT": _invert, "HUE_SAT": _hue,
    "BRIGHTCONTRAST": _contrast, "RGBTOBW": lambda _node, _output, given: _grey(given[0]),
    "GAMMA": lambda _node, _output, given: np.power(np.maximum(given.colour(0), 0.0), given[1][:, None]),
    "CLAMP": lambda _node, _output, given: np.clip(given[0], given[1], given[2])}
