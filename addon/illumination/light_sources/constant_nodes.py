"""Evaluate nodes with constant results: numbers, colours, and the colour of a black body."""
from __future__ import annotations

import bpy
import numpy as np

from ...writing.nodes.shader_builder import node_behind

WAVES = np.arange(360.0, 831.0, 5.0)  # nanometres
SECOND_RADIATION = 1.438776877e7      # h c / k, nm K
# linear Rec. 709 of CIE XYZ, as IEC 61966-2-1 has it
TO_RGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
# heights, middles in nm, and slopes to the left and right of each of the waves that the observer is a sum of
OBSERVER = (((1.056, 599.8, 0.0264, 0.0323), (0.362, 442.0, 0.0624, 0.0374), (-0.065, 501.1, 0.0490, 0.0382)),
            ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
            ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)))
COLDEST, HOTTEST = 800.0, 12000.0     # K: Cycles knows no other colours


def constant(socket: bpy.types.NodeSocket) -> np.ndarray | None:
    """Return the constant number or colour (3,) of a socket. Return None if it varies or comes from unknown nodes."""
    if not socket.is_linked:
        return plain(socket)
    node = node_behind(socket)
    if node is None or node.mute:
        return None
    if node.type in {"VALUE", "RGB"}:
        return plain(node.outputs[0])
    if node.type == "BLACKBODY" and not node.inputs[0].is_linked:
        return black_body(node.inputs[0].default_value)
    return None


def black_body(kelvin: float) -> np.ndarray:
    """Return the linear red, green and blue (3,) of black-body light with luminance 1, never negative.

    M. Planck's law, seen by the observer of C. Wyman, P.-P. Sloan and P. Shirley, "Simple Analytic Approximations to
    the CIE XYZ Color Matching Functions", Journal of Computer Graphics Techniques 2 (2013).
    """
    exponent = SECOND_RADIATION / (WAVES * min(max(kelvin, COLDEST), HOTTEST))
    # relative to the longest wavelength, since only the ratios matter for the colour
    light = np.exp(exponent.min() - exponent) / WAVES**5 / (1.0 - np.exp(-exponent))
    xyz = np.array([sum(height * np.exp(-0.5 * ((WAVES - middle) * np.where(WAVES < middle, left, right))**2)
                        for height, middle, left, right in lobes) @ light for lobes in OBSERVER])
    return np.maximum(TO_RGB @ (xyz / xyz[1]), 0.0)


def plain(socket: bpy.types.NodeSocket) -> np.ndarray:
    """Return a socket's own number, or its red, green and blue."""
    value = np.array(socket.default_value, dtype=np.float64)
    return value[:3] if value.ndim else value
