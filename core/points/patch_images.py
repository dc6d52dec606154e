"""Images of vertices on a patch, where each has one at the most, and just beyond its border."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import INSIDE, drawn_in, least_weight, settle
from ..geometry import rows
from ..patches import Descent, Patch, Walk
from ..support import portions
from ..trees import SMALL, PointTree
from .point_images import PointImages

AT_ONCE = 8192  # vertices: what their arrays take fits the cache
BESIDE, STRAYING = 32.0, 1.0  # pixels: further over the border nothing is looked for; what cameras stray by


@np.errstate(all="ignore")  # what is too large or too small to be told has no image
def images_on_patch(patch: Patch, tree: PointTree,
                    elsewhere: np.ndarray) -> tuple[PointImages, np.ndarray, dict[str, int]]:
    """The images that a patch shows of the vertices of a tree, and those just over its border to faces seen
    `elsewhere`.

    Returns
    -------
    images : PointImages
    stood_for : (v,) bool, vertices of which another one is looked for
    counts : dict, nodes visited, vertices looked for, both together, images found
    """
    walk = Walk(patch)
    descent, wanted = Descent(walk, tree, SMALL), 0
    found, left = [PointImages.none()], [PointImages.none()]
    for some in descent.vertices():
        wanted += len(some.vertex)
        for part in portions(len(some.vertex), AT_ONCE):
            vertex = some.vertex[part]
            looked = walk.images(rows(tree.mesh.positions[vertex]) - patch.eye, some.nodes, some.node[part])
            sure, lost = _split(patch, vertex, some.stood[part], looked)
            found.append(sure)
            left.append(lost)
    lost = PointImages.joined(left)
    looked = walk.afresh(rows(tree.mesh.positions[lost.vertex]) - patch.eye)
    sure, lost = _split(patch, lost.vertex, lost.stood, looked)
    found += [sure, _over_border(patch, lost, tree, elsewhere)]
    images = PointImages.joined(found)
    counts = {"nodes_visited": walk.asked - wanted, "pairs": wanted, "projections": walk.asked, "roots": len(images)}
    stood_for = descent.standing != np.arange(len(descent.standing))
    return replace(images, uv=drawn_in(images.uv)), stood_for, counts


def _split(patch: Patch, vertex: np.ndarray, stood: np.ndarray, looked: tuple) -> tuple[PointImages, PointImages]:
    """Images that are found, as what `find` tells, and what is left at other places."""
    member, uv, s, found = looked
    found &= least_weight(uv) >= -INSIDE
    images = PointImages(vertex, patch.face[member], uv, s, stood)
    return images.select(np.flatnonzero(found)), images.select(np.flatnonzero(~found))


def _over_border(patch: Patch, images: PointImages, tree: PointTree, elsewhere: np.ndarray) -> PointImages:
    """Images that Newton's method has left for over the border: the way to some on the patch leads round a corner of
    it, and some close by are seen on the patch by the cameras there, which interpolate, and left to it."""
    mirror_map, view = patch.mirror_map, patch.view

    def pixels(face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return view.pixels(mirror_map.places(face, uv).T)

    outside = pixels(images.face, images.uv) - pixels(images.face, drawn_in(images.uv))
    images = images.select((np.linalg.norm(outside, axis=1) < BESIDE) & (images.distance > 0.0))
    points = rows(tree.mesh.positions[images.vertex])
    face, uv, s, real = settle(mirror_map, images.face, images.uv, images.distance, points)
    real &= mirror_map.meets(face, uv, s, points)
    spot = rows(pixels(face, uv))
    close = patch.border.touched(spot - STRAYING, spot + STRAYING)
    real &= np.isin(face, patch.face) | (close & np.isin(face, elsewhere))
    return PointImages(images.vertex, face, uv, s, images.stood).select(real)
