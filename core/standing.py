"""A cache for frames in which scene and mirrors do not move: the scene's tree, and data derived from the mirrors."""
from __future__ import annotations

from dataclasses import dataclass

from .culling import SceneAndMirrors
from .geometry import Order, TriangleMesh, ordered
from .trees import PointTree, SceneTree


@dataclass(frozen=True)
class Standing:
    """A cached diffuse scene with mirrors, to pass to `reflect` in place of the scene while neither moves.

    The `mirror` argument of `reflect` may still be another mesh, or move.

    Attributes
    ----------
    tree : SceneTree or PointTree
    mirrors : TriangleMesh
        All input mirrors, in their original order.
    order : Order
        Canonical order of the mirrors, which `met` uses.
    met : SceneAndMirrors

    Examples
    --------
    >>> import numpy as np
    >>> from core import Standing, TriangleMesh, View, reflect
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> standing = Standing.of(scene, mirror)
    >>> for x in (0.0, 0.1):  # frames
    ...     mesh = reflect(View.looking_at((x, -4, 3), (0, 0, 0), (320, 240)), mirror, standing)
    >>> mesh.source_face.min().item()
    0
    """

    tree: SceneTree | PointTree
    mirrors: TriangleMesh
    order: Order
    met: SceneAndMirrors

    @classmethod
    def of(cls, scene: TriangleMesh | SceneTree | PointTree, mirrors: TriangleMesh) -> Standing:
        """Build the cache of a scene and of all `mirrors` that may be seen in each other, all in world space."""
        tree = SceneTree.build(scene) if isinstance(scene, TriangleMesh) else scene
        met, order = ordered(mirrors, shading=True)
        return cls(tree, mirrors, order, SceneAndMirrors(tree, met, given=order.triangle))
