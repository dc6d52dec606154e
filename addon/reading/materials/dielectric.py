"""The layer over the colour of a Principled BSDF, which reflects as a dielectric does."""
from __future__ import annotations

import math

import bpy

MOST = 0.99  # largest reflectance at normal incidence


def upright(shader: bpy.types.Node) -> float:
    """Return the reflectance of the dielectric layer at normal incidence. Linked sockets count with their unlinked
    value.
    """
    index, level = (shader.inputs[name].default_value for name in ("IOR", "Specular IOR Level"))
    return min(2.0 * level * ((index - 1.0) / (index + 1.0))**2, MOST)


def index_of(shader: bpy.types.Node) -> float:
    """Return the refractive index of a dielectric with the reflectance `upright(shader)` at normal incidence."""
    root = math.sqrt(max(upright(shader), 0.0))
    return (1.0 + root) / (1.0 - root)
