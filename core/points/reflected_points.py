"""Point-based rendering: every image of a diffuse vertex as a flat disc, for scenes finer than the picture.

Nothing is clipped and nothing joined: where triangles are smaller than a pixel, what lies inside them cannot be seen.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, MirrorMap, drawn_in, settle
from ..culling import Cones, Magnification, PointTree, SceneAndMirrors
from ..geometry import norm, rows
from ..polygons import VertexImages, images_of_pairs, repeated
from ..result import Discs, ReflectionMesh
from ..result import place as placed
from ..support import Progress
from .beams import Beams
from .disc_shapes import LARGEST, flat_discs, picture_ellipses
from .hidden_points import hidden_by_mirrors

PAIRS_AT_ONCE = 131072
ON_CAUSTIC = 1e-9  # magnification


def reflected_points(cameras: Cameras, tree: PointTree, met: SceneAndMirrors, placement: str,
                     progress: Progress) -> ReflectionMesh:
    """Every image of the tree's vertices in the cameras, once, as a point with its disc."""
    images, reach, counts = _images(cameras, tree, progress)
    images, reach, face, uv = _settled(cameras, images, reach, tree.mesh.positions, met)
    counts["images"] = len(reach)

    progress.next(0.75, "discs")
    view, mirror_map = cameras.view, cameras.mirror_map
    assert isinstance(mirror_map, MirrorMap)  # points follow one bounce only
    turned = mirror_map.turned(face, uv, images.distance)
    parity = np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned)).astype(np.int8)
    # what stands for others beside it has no one plane
    normal = np.where(reach == 0.0, tree.normal[:, images.vertex], 0.0)
    axes, wanted = picture_ellipses(mirror_map, face, uv, images.distance, normal, tree.reach[images.vertex] + reach)
    counts["coarse"] = int((wanted > LARGEST).sum())
    point = rows(tree.mesh.positions[images.vertex])
    path = norm(point - images.place)
    drawn = placed(view, images.place, path, placement)
    slope = None if placement == "VIRTUAL" else mirror_map.surface.face_normal[:, face]
    flat, radius = flat_discs(view, images.place, axes, slope, drawn)
    return ReflectionMesh(
        positions=drawn.T, triangles=np.zeros((0, 3), dtype=np.int64), reflected_position=point.T,
        mirror_position=images.place.T, path_length=path, image_parity=parity,
        source_face=np.zeros(0, dtype=np.int64), source_weights=np.zeros((0, 3, 3)),
        mirror_face=np.zeros(0, dtype=np.int64), counts=counts,
        estimated_error=float(np.percentile(np.minimum(wanted, LARGEST), 99)) if len(wanted) else 0.0,
        discs=Discs(images.vertex, face, np.stack((1.0 - uv[0] - uv[1], *uv), axis=1), radius, flat))


def _images(cameras: Cameras, tree: PointTree,
            progress: Progress) -> tuple[VertexImages, np.ndarray, dict[str, int]]:
    """Images as each camera finds them, how far the vertices reach that each stands for (n,), and counts."""
    progress.next(0.2, "cones through the tree")
    cones, positions = Cones.around(cameras), tree.mesh.positions
    pairs = tree.trace(cones, Magnification.of(cameras))
    counts = {"nodes_visited": pairs.visited, "pairs": len(pairs.camera), "stood_for": pairs.stood_for,
              "projections": 0, "roots": 0}
    found, reach, beams = [], [], Beams.of(cameras, cones)
    for start in range(0, max(len(pairs.camera), 1), PAIRS_AT_ONCE):
        progress.next(0.3 + 0.4 * start / max(len(pairs.camera), 1), "projection")
        part = slice(start, start + PAIRS_AT_ONCE)
        camera, vertex, stood = pairs.camera[part], pairs.vertex[part], pairs.stood[part]
        held = beams.hold(camera, rows(positions[vertex]))
        images, solved, pair = images_of_pairs(cameras, positions, camera[held], vertex[held])
        found.append(images)
        reach.append(stood[held][pair])
        for name in ("projections", "roots"):
            counts[name] += solved[name]
    return VertexImages.joined(found), np.concatenate(reach), counts


def _settled(cameras: Cameras, images: VertexImages, reach: np.ndarray, positions: np.ndarray,
             met: SceneAndMirrors) -> tuple[VertexImages, np.ndarray, np.ndarray, np.ndarray]:
    """Images that the eye sees, each once, on the triangle of the mirror that it truly lies on; how far each stands
    for, and its face (n,) and place (u, v)."""
    mirror_map = cameras.mirror_map
    assert isinstance(mirror_map, MirrorMap)
    face = cameras.face[images.camera]
    face, uv, distance, real = settle(mirror_map, face, mirror_map.coordinates(face, images.place),
                                      images.distance, rows(positions[images.vertex]))
    # what lies between two triangles is shown on the edge of one
    uv = drawn_in(uv)
    place = mirror_map.places(face, uv)
    images = VertexImages(images.vertex, images.camera, distance, place, cameras.view.pixels(place.T))
    # of one image, that which stands for most is kept
    order = np.lexsort((images.camera, -reach, images.vertex))
    hidden = hidden_by_mirrors(met, cameras, images.camera, place, positions[images.vertex].T)
    order = order[(real & ~hidden)[order]]
    order = order[~repeated(images.select(order))]
    return images.select(order), reach[order], face[order], uv[:, order]
