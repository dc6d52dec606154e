"""The values of one attribute of a mesh."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Attribute:
    """The name, type and values of an attribute that is written into a mesh.

    Attributes
    ----------
    name : str
    kind : str
        `data_type` of `bpy.types.Attribute`, such as "FLOAT2".
    domain : str
        `domain` of `bpy.types.Attribute`: "POINT", "FACE" or "CORNER".
    values : np.ndarray
        One value for each element of the domain, in Blender's order. Components are on the last axis; corners of
        triangles may have two axes (m, 3).
    """

    name: str
    kind: str
    domain: str
    values: np.ndarray
