"""The values of one attribute of a mesh."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Attribute:
    """The values of one attribute; `kind` and `domain` in Blender's words."""

    name: str
    kind: str
    domain: str
    values: np.ndarray
