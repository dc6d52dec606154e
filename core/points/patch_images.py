"""Images of vertices on a patch, where each has one at the most, and just beyond its border."""
from __future__ import annotations

import numpy as np

from ..cameras import INSIDE, drawn_in, settle
from ..culling import PointTree
from ..geometry import rows
from ..patches import Patch
from ..support import breathe
from .patch_nodes import Descent, NodeVertices, Walk
from .point_images import PointImages

AT_ONCE = 8192  # vertices: what their arrays take fits the cache
BESIDE, STRAYING = 32.0, 1.0  # pixels: further over the border nothing is looked for; what cameras stray by


@np.errstate(all="ignore")  # what is too large or too small to be told has no image
def images_on_patch(patch: Patch, tree: PointTree) -> tuple[PointImages, np.ndarray, dict[str, int]]:
    """The images that a patch shows of the vertices of a tree.

    Returns
    -------
    images : PointImages
    stood_for : (v,) bool
        Vertices of which another one is looked for.
    counts : dict
        Nodes visited, vertices looked for, both together, images found.
    """
    walk = Walk(patch)
    descent, wanted = Descent(walk, tree), 0
    found: list[PointImages] = []
    for some in descent.vertices():
        descent.covered[some.vertex] = False
        wanted += len(some.vertex)
        for start in range(0, len(some.vertex), AT_ONCE):
            breathe()
            found.append(_found(walk, tree, some, slice(start, start + AT_ONCE)))
    images = PointImages.joined(found)
    return images, descent.covered, {"nodes_visited": walk.asked - wanted, "pairs": wanted, "projections": walk.asked,
                                     "roots": len(images)}


def _found(walk: Walk, tree: PointTree, some: NodeVertices, part: slice) -> PointImages:
    """The images of a part of the vertices."""
    patch, vertex, stood = walk.patch, some.vertex[part], some.stood[part]
    points = rows(tree.mesh.positions[vertex])
    member, uv, s, found = walk.images(points - patch.eye, some.nodes, some.node[part])
    face = patch.face[member]
    _over_border(patch, face, uv, s, found, points)
    seen = np.flatnonzero(found)
    return PointImages(vertex[seen], face[seen], drawn_in(uv[:, seen]), s[seen], stood[seen])


def _over_border(patch: Patch, face, uv, s, found, points) -> None:
    """Images that are looked for over the border, in the arrays given: the way to some on the patch leads round a
    corner of it, and some close by are seen on the patch by the cameras there, which interpolate, and left to it."""
    mirror_map, view = patch.mirror_map, patch.view
    left = np.flatnonzero((s > 0.0) & ~(found & (np.minimum(uv.min(axis=0), 1.0 - uv[0] - uv[1]) >= -INSIDE)))
    found[left] = False
    border, outside = (view.pixels(mirror_map.places(face[left], at).T) for at in (drawn_in(uv[:, left]), uv[:, left]))
    left = left[np.linalg.norm(outside - border, axis=1) < BESIDE]
    face[left], uv[:, left], s[left], real = settle(mirror_map, face[left], uv[:, left], s[left], points[:, left])
    real &= mirror_map.meets(face[left], uv[:, left], s[left], points[:, left])
    left = left[real]
    pixel = rows(view.pixels(mirror_map.places(face[left], uv[:, left]).T))
    found[left] = np.isin(face[left], patch.face) | patch.border.touched(pixel - STRAYING, pixel + STRAYING)
