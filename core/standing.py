"""What stands still from frame to frame: the diffuse scene with its tree, and the mirrors with all that their shape
tells."""
from __future__ import annotations

from dataclasses import dataclass

from .culling import SceneAndMirrors
from .geometry import Order, TriangleMesh, ordered
from .trees import PointTree, SceneTree


@dataclass(frozen=True)
class Standing:
    """A diffuse scene and mirrors for `reflect` in place of the scene, worked out once while both stand still; the
    mirror that it is asked for may be another one, or move.

    Attributes
    ----------
    tree : SceneTree or PointTree
    mirrors : TriangleMesh
        All mirrors, as they were given.
    order : Order
        Of the mirrors, which `met` holds in their canonical order.
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
        """Of a scene, and all mirrors that may be seen in each other."""
        tree = SceneTree.build(scene) if isinstance(scene, TriangleMesh) else scene
        met, order = ordered(mirrors, shading=True)
        return cls(tree, mirrors, order, SceneAndMirrors(tree, met, given=order.triangle))
