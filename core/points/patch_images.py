"""Images of vertices on a patch, where each vertex has at most one image, and just across its border."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import INSIDE, drawn_in, least_weight, settle
from ..geometry import rows
from ..patches import Descent, Patch, Walk
from ..support import portions
from ..trees import SMALL, PointTree
from .point_images import PointImages

AT_ONCE = 8192  # vertices per chunk, whose arrays fit the CPU cache
BESIDE, STRAYING = 32.0, 1.0  # pixels: largest distance of a searched image from the border; deviation of cameras


@np.errstate(all="ignore")  # values that overflow or underflow give no image
def images_on_patch(patch: Patch, tree: PointTree,
                    elsewhere: np.ndarray) -> tuple[PointImages, np.ndarray, dict[str, int]]:
    """Find the images of a tree's vertices on a patch, and just across its border.

    Parameters
    ----------
    elsewhere : (k,) int64, mirror triangles outside of the patch that cameras show

    Returns
    -------
    images : PointImages
    stood_for : (v,) bool, True for vertices that another one represents
    counts : dict, numbers of nodes visited, of vertices searched, of both together, and of images found
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
    """Split the result `looked` of `find` into images found on the patch, and last places of the others."""
    member, uv, s, found = looked
    found &= least_weight(uv) >= -INSIDE
    images = PointImages(vertex, patch.face[member], uv, s, stood)
    return images.select(np.flatnonzero(found)), images.select(np.flatnonzero(~found))


def _over_border(patch: Patch, images: PointImages, tree: PointTree, elsewhere: np.ndarray) -> PointImages:
    """Find images that Newton's method lost over the patch's border, by a walk over the whole mirror.

    Some lie on the patch, but the walk to them leads around a corner of it. Others lie just across the border. The
    cameras there interpolate, see these on the patch, and leave them to it. `images` holds the last places.
    """
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
