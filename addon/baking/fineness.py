"""How many texels the light on an object has for each pixel in which it is seen."""
from __future__ import annotations

import numpy as np

from ..reading import DiffuseScene, materials_of
from ..reading.materials import outshines_paper
from .texels import has_pattern

FINER = 1.5  # texels a pixel along a line: interpolation and the picture's filter blur them
FINER_LAMPS = 4.5  # of what shines in a pattern: between texels a bright stripe's half is still white


def fineness(scene: DiffuseScene) -> np.ndarray:
    """Texels a pixel along a line, (k,), of each source of a scene."""
    return np.array([FINER_LAMPS if any(has_pattern(one) and outshines_paper(one) for one in materials_of(source))
                     else FINER for source in scene.sources])
