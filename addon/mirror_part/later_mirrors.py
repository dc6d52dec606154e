"""What mirrors take of the light that the eye sees by more than one of them."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ..reading import is_result
from ..writing.nodes.shader_builder import ShaderBuilder
from .mirror_share import WHITE, Share

FLAT = 1e-4  # of a mirror's size: what strays less from a plane cannot see itself


@dataclass(frozen=True)
class LaterMirrors:
    """The mirrors that a mirror shows mirrors in.

    Attributes
    ----------
    tint : tuple of float
        Their colour, straight on; white where theirs differ, since a result does not tell which of them it was.
    most : int
        By how many mirrors what is shown is seen, at most.
    """

    tint: tuple = WHITE
    most: int = 1

    @classmethod
    def of(cls, result: bpy.types.Object, objects: Iterable[bpy.types.Object]) -> LaterMirrors:
        """Of a result, beside the other results among `objects`."""
        most, mirror = _most_bounces(result), result.reflection_mesh.mirror
        if most < 2:
            return cls()
        mirrors = {obj.reflection_mesh.mirror for obj in objects if is_result(obj)} - {None}
        tints = {share.tint for other in mirrors if other != mirror or not _is_flat(other) for share in Share.of(other)}
        return cls(tints.pop(), most) if len(tints) == 1 else cls()

    def leave(self, build: ShaderBuilder, colour):
        """What they leave of light of a colour, a socket or the colour itself."""
        if self.tint == WHITE:
            return colour
        bounces = build.add("ShaderNodeAttribute", attribute_name="bounces").outputs["Fac"]
        for count in range(2, self.most + 1):
            met = build.calculated("GREATER_THAN", bounces, count - 0.5)
            colour = build.blended("MULTIPLY", met, colour, self.tint)
        return colour


def _most_bounces(result: bpy.types.Object) -> int:
    """By how many mirrors the eye sees what a result shows, at most."""
    known = result.data.attributes.get("bounces")
    if known is None or not len(known.data):
        return 1
    values = np.empty(len(known.data), dtype=np.int32)
    known.data.foreach_get("value", values)
    return int(values.max())


def _is_flat(mirror: bpy.types.Object) -> bool:
    if mirror.type != "MESH" or mirror.modifiers or not len(mirror.data.vertices):
        return False
    points = np.empty((len(mirror.data.vertices), 3), dtype=np.float32)
    mirror.data.attributes["position"].data.foreach_get("vector", points.reshape(-1))
    points = points.astype(np.float64) - points.mean(axis=0)
    sizes = np.linalg.svd(points, compute_uv=False)
    return bool(sizes[-1] <= FLAT * sizes[0]) if len(points) > 2 else True
