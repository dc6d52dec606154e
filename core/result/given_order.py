"""Renumbering of results: from meshes in canonical order, which the method works on, to the meshes that were given."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import TURNS, Order
from .reflection_mesh import ReflectionMesh


def in_given_order(result: ReflectionMesh, scene: Order, mirror: Order) -> ReflectionMesh:
    """Renumber the result of ordered meshes to the indices of the meshes that were given."""
    back = TURNS[-scene.first[result.source_face] % 3]
    discs = result.discs
    if discs is not None:
        turn = TURNS[-mirror.first[discs.mirror_face] % 3]
        discs = replace(discs, source_vertex=scene.vertex[discs.source_vertex],
                        mirror_face=mirror.triangle[discs.mirror_face],
                        mirror_weights=np.take_along_axis(discs.mirror_weights, turn, axis=1))
    known = result.mirror_face >= 0
    return replace(
        result, source_face=scene.triangle[result.source_face],
        source_weights=np.take_along_axis(result.source_weights, back[:, None, :], axis=2),
        mirror_face=np.where(known, mirror.triangle[result.mirror_face], -1), discs=discs)
