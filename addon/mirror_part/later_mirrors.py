"""What mirrors take of the light that the eye sees by more than one of them."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ..reading import is_result, vectors
from ..writing.nodes.shader_builder import ShaderBuilder
from .mirror_share import WHITE, Share

FLAT = 1e-4  # of a mirror's size: what strays less from a plane, or from its own convex body, cannot see itself
MOST_PAIRS, AT_ONCE = 1 << 27, 1 << 20  # of corners and faces that are looked at, in all and at once


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
        # by way of another one it may be met again, be it convex
        own = not _is_flat(mirror) and not (most == 2 and _is_convex(mirror, result.reflection_mesh.camera))
        tints = {share.tint for other in mirrors if own or other != mirror for share in Share.of(other)}
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
    points = vectors(mirror.data, "position")
    sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(sizes[-1] <= FLAT * sizes[0]) if len(points) > 2 else True


def _is_convex(mirror: bpy.types.Object, camera: bpy.types.Object | None) -> bool:
    """Whether a mirror bounds one convex body, and the camera is not within."""
    mesh = mirror.data
    if mirror.type != "MESH" or mirror.modifiers or len(mesh.vertices) * len(mesh.polygons) > MOST_PAIRS:
        return False
    # closed: each edge is a side of two faces
    if camera is None or not len(mesh.polygons) or len(mesh.loops) != 2 * len(mesh.edges):
        return False
    eye = mirror.matrix_world.inverted_safe() @ camera.matrix_world.translation
    points = np.vstack((vectors(mesh, "position"), eye))
    centre, normal = np.empty((2, len(mesh.polygons), 3), dtype=np.float32)
    mesh.polygons.foreach_get("center", centre.reshape(-1))
    mesh.polygons.foreach_get("normal", normal.reshape(-1))
    room, highest = FLAT * float(np.ptp(points[:-1], axis=0).max()), np.full(len(points), -np.inf)
    for part in np.array_split(np.arange(len(normal)), len(points) * len(normal) // AT_ONCE + 1):
        heights = normal[part] @ points.T - (normal[part] * centre[part]).sum(axis=1)[:, None]
        highest = np.maximum(highest, heights.max(axis=0))
    return bool((highest[:-1] <= room).all() and highest[-1] > 0.0)
