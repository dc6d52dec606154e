"""The layer over the colour of a Principled BSDF, which reflects as a dielectric does."""
from __future__ import annotations

import math

import bpy

MOST = 0.99  # of upright light that any gloss sends back


def upright(shader: bpy.types.Node) -> float:
    """What part of upright light the layer sends back, by values that are plugged off."""
    index, level = (shader.inputs[name].default_value for name in ("IOR", "Specular IOR Level"))
    return min(2.0 * level * ((index - 1.0) / (index + 1.0))**2, MOST)


def index_of(shader: bpy.types.Node) -> float:
    """The refractive index of what sends back as much of light, by the angle."""
    root = math.sqrt(max(upright(shader), 0.0))
    return (1.0 + root) / (1.0 - root)
