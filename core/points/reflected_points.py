"""Point-based rendering: every image of a diffuse vertex as a flat disc, for scenes finer than the picture.

Triangles smaller than a pixel need neither clipping nor connected faces, because their inside cannot be seen.
"""
from __future__ import annotations

import numpy as np

from ..cameras import ALONG_UV, Cameras, MirrorMap, drawn_in, grown, settle
from ..culling import SceneAndMirrors
from ..geometry import columns, norm, rows
from ..patches import Patch
from ..polygons import VertexImages, images_of_pairs
from ..result import Discs, ReflectionMesh
from ..result import place as placed
from ..support import Progress, portions
from ..trees import Cones, Magnification, PointTree
from .beams import Beams
from .disc_shapes import LARGEST, flat_discs, picture_ellipses
from .hidden_points import hidden_by_mirrors
from .patch_images import images_on_patch
from .point_images import PointImages

PAIRS_AT_ONCE = 131072
AT_ONCE = 8192  # images per chunk, whose arrays fit the CPU cache
ON_CAUSTIC = 1e-9  # area growth below which an image counts as lying on a caustic


def reflected_points(cameras: Cameras, patch: Patch | None, met: SceneAndMirrors, placement: str,
                     progress: Progress) -> ReflectionMesh:
    """Compute all images of the scene's vertices, as points with discs.

    The `patch`, if there is one, shows images on its part of the mirror; the `cameras` show those on the rest. Each
    image is returned once.
    """
    tree, mirror_map = met.tree, cameras.mirror_map
    assert isinstance(tree, PointTree) and isinstance(mirror_map, MirrorMap)  # points follow one bounce only
    images, stood_for, counts = _images(cameras, tree, met, progress)
    if patch is not None:
        progress.next(0.6, "Reflecting vertices")
        own, also, more = images_on_patch(patch, tree, cameras.face)
        images = own.with_others(images, mirror_map, len(stood_for))
        counts = {name: count + more[name] for name, count in counts.items()}
        stood_for |= also
    # one traversal of the tree for each camera, and one for the patch
    counts.update(descents=len(cameras) + (patch is not None), images=len(images), stood_for=int(stood_for.sum()))
    progress.next(0.75, "Building points")
    return _drawn(mirror_map, tree, images, (placement, met.slide), counts)


def _drawn(mirror_map: MirrorMap, tree: PointTree, images: PointImages, how: tuple[str, float],
           counts: dict[str, int]) -> ReflectionMesh:
    """Build the result from images of scene points: a vertex for each, with the axes of the disc that shows it.

    `how` is the placement, one of `PLACEMENTS`, and the factor on the offset of layers (`SceneAndMirrors.slide`).
    """
    placement, slide = how
    view, surface, count = mirror_map.view, mirror_map.surface, len(images)
    point, spot, flat = np.empty((3, count)), np.empty((3, count)), np.empty((count, 2, 3))
    axes, wanted, radius = np.empty((2, 2, count)), np.empty(count), np.empty(count)
    parity = np.empty(count, dtype=np.int8)
    for part in portions(count, AT_ONCE):
        some = images.select(part)
        seen = mirror_map.linearise(some.face, some.uv, *ALONG_UV)
        turned = grown(seen, some.distance)
        parity[part] = np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned))
        normal, reach = columns(tree.normal, some.vertex), tree.reach[some.vertex] + some.stood
        # representatives have no single plane; lifted rays beyond the shading horizon have no valid magnification
        normal[:, some.stood > 0.0] = 0.0
        reach[mirror_map.lifted(some.face, some.uv)] = 0.0
        axes[:, :, part], wanted[part] = picture_ellipses(view, seen, some.distance, normal, reach)
        point[:, part], spot[:, part] = tree.mesh.positions[some.vertex].T, seen[0]
    path = norm(point - spot)
    drawn = placed(view, spot, path, placement, share=slide)
    for part in portions(count, AT_ONCE):
        slope = None if placement == "VIRTUAL" else columns(surface.face_normal, images.face[part])
        flat[part], radius[part] = flat_discs(view, axes[:, :, part], slope, drawn[:, part])
    counts["coarse"] = int((wanted > LARGEST).sum())
    weights = np.stack((1.0 - images.uv[0] - images.uv[1], *images.uv), axis=1)
    return ReflectionMesh(
        positions=drawn.T, triangles=np.zeros((0, 3), dtype=np.int64), reflected_position=point.T,
        mirror_position=spot.T, path_length=path, image_parity=parity,
        source_face=np.zeros(0, dtype=np.int64), source_weights=np.zeros((0, 3, 3)),
        mirror_face=np.zeros(0, dtype=np.int64), counts=counts,
        estimated_error=float(np.percentile(np.minimum(wanted, LARGEST), 99)) if count else 0.0,
        discs=Discs(images.vertex, images.face, weights, radius, flat))


def _images(cameras: Cameras, tree: PointTree, met: SceneAndMirrors,
            progress: Progress) -> tuple[PointImages, np.ndarray, dict[str, int]]:
    """Find the images in each camera.

    Returns
    -------
    images : PointImages
    covered : (v,) bool, True for vertices that another one represents
    counts : dict
    """
    progress.next(0.2, "Finding reflected objects")
    cones, positions = Cones.around(cameras), tree.mesh.positions
    pairs = tree.trace(cones, Magnification.of(cameras))
    counts = {"nodes_visited": pairs.visited, "pairs": len(pairs.camera), "projections": 0, "roots": 0}
    pairs.covered[pairs.vertex] = False
    found, stood, beams = [], [], Beams.of(cameras, cones)
    for part in portions(max(len(pairs.camera), 1), PAIRS_AT_ONCE):
        progress.next(0.3 + 0.3 * part.start / max(len(pairs.camera), 1), "Reflecting vertices")
        camera, vertex, radius = pairs.camera[part], pairs.vertex[part], pairs.stood[part]
        held = beams.hold(camera, rows(positions[vertex]))
        seen, solved, pair = images_of_pairs(cameras, positions, camera[held], vertex[held])
        found.append(seen)
        stood.append(radius[held][pair])
        for name in ("projections", "roots"):
            counts[name] += solved[name]
    images = _settled(cameras, VertexImages.joined(found), np.concatenate(stood), positions, met)
    return images, pairs.covered, counts


def _settled(cameras: Cameras, images: VertexImages, stood: np.ndarray, positions: np.ndarray,
             met: SceneAndMirrors) -> PointImages:
    """Move images to the mirror triangle that they lie on, and drop hidden and duplicate ones.

    `stood` (n,) are the radii of the vertices that each image represents.
    """
    mirror_map = cameras.mirror_map
    assert isinstance(mirror_map, MirrorMap)
    face = cameras.face[images.camera]
    face, uv, distance, real = settle(mirror_map, face, mirror_map.coordinates(face, images.place),
                                      images.distance, rows(positions[images.vertex]))
    # move images between two triangles to the edge of one
    uv = drawn_in(uv)
    place = mirror_map.places(face, uv)
    hidden = hidden_by_mirrors(met, cameras, images.camera, place, positions[images.vertex].T)
    return PointImages(images.vertex, face, uv, distance, stood).select(real & ~hidden).once(mirror_map)
