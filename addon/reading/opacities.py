"""Opacities of the triangles of a scene: which let light through, and which the camera looks through."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import Opacity
from .looked_through import is_unseen
from .materials import is_colourless, is_opaque
from .meshes import DiffuseScene


def opacities_of(depsgraph: bpy.types.Depsgraph, scene: DiffuseScene) -> np.ndarray:
    """Return `core.Opacity` (m,) of each triangle: by its material, and by whether the camera sees its source."""
    kinds = np.array([_opacity(material) for material in scene.materials], dtype=np.int8)
    found = kinds[scene.material]
    unseen = np.array([is_unseen(source, depsgraph.view_layer) for source in scene.sources])[scene.source_object]
    found[unseen & (found == Opacity.OPAQUE)] = Opacity.UNSEEN
    found[unseen & (found == Opacity.OPEN)] = Opacity.CLEAR
    return found


def _opacity(material: bpy.types.Material | None) -> Opacity:
    if is_opaque(material):
        return Opacity.OPAQUE
    return Opacity.CLEAR if is_colourless(material) else Opacity.OPEN
