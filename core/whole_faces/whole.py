"""Whole faces: triangles that the patch of a mirror shows whole, drawn from the images of their vertices."""
from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..cameras import Cameras, picture_areas
from ..culling import SceneAndMirrors, ScenePieces
from ..geometry import TriangleMesh, mask, norm, rows
from ..patches import Patch, speck
from ..support import FACE_SHARE, TOGETHER, Settings, breathe
from ..trees import Cones, SceneTree
from ..views import LampView
from .contacts import contacts
from .division import Division
from .drawn import ROOM, drawn_or_left, shown_or_behind
from .images import Images
from .layers import Layers
from .merging import Merged
from .pieces import Pieces, turned_away, whole
from .sinking import Sinking

LEAST_TRIANGLES, LEAST_PATCH = 8000, 32  # triangles of the scene, and of a patch: clipping is faster for fewer
LEAST_SHARE = 0.25  # share of the visible mirror: a smaller patch is not worth it
FAR = 64.0  # pixels by which edges that leave the patch may be longer
WAYS = ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2))  # from corner to corner of a triangle
PROBES = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (1 / 3, 1 / 3))
WIDER = 1.25  # factor on the spread of a triangle's rays at its corners, or at its probes, to bound the rays between
TURNING = 0.05  # sine of how far the rays at a triangle's corners turn, beyond which it is probed between them too


@dataclass(frozen=True)
class WholeFaces:
    """Pieces of scene triangles that are drawn unclipped, and pieces that are left to cameras.

    Attributes
    ----------
    positions : (n, 3) float64, of the scene's vertices
    patch : Patch
    images : Images, of the scene's vertices, then of the nodes at which its triangles were split
    merged : (m, 3) int64, optional, the scene's triangles with representative vertices, if some were merged
    pieces : Pieces (f), of all triangles
    drawn : (f,) bool, True for pieces that are drawn
    left : (f,) bool, True for pieces that are left to the patch's cameras; nearer pieces hide all others
    hidden : int, number of hidden pieces, with those that are not among `pieces`
    straying : (2, e) float64, deviation and length of edges, in pixels
    limited : int, number of edges that were not split because there would be too many pieces
    """

    positions: np.ndarray
    patch: Patch
    images: Images
    merged: np.ndarray | None
    pieces: Pieces
    drawn: np.ndarray
    left: np.ndarray
    hidden: int
    straying: np.ndarray
    limited: int

    def scene_pieces(self) -> ScenePieces:
        """Return the pieces that are left to the cameras of the patch, and the parts of the picture that they cover."""
        pieces, patch, points = self.pieces.select(self.left), self.patch, self.images.point
        low, high, unknown = _boxes(patch, self.images, pieces.nodes)
        cells = patch.border.with_boxes(low[:, ~unknown], high[:, ~unknown])
        seeing = _seeing(patch, points[:, pieces.nodes[:, unknown]])
        on_patch, open_ = (mask(len(patch.mirror_map.surface), face) for face in (patch.face, patch.face[seeing]))
        positions = np.concatenate((self.positions, (points[:, len(self.positions):] + patch.eye).T))
        return ScenePieces(TriangleMesh(positions, pieces.nodes.T), pieces.source, on_patch, cells, open_, self.merged)


def _worth_it(cameras: Cameras, patch: Patch) -> bool:
    """Return True if the patch covers more than `LEAST_SHARE` of the visible mirror."""
    areas = picture_areas(cameras)
    return bool(areas[np.isin(cameras.face, patch.face)].sum() > LEAST_SHARE * areas.sum())


def _boxes(patch: Patch, images: Images, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bound the images of pieces with corners `nodes` (3, f) by boxes in the picture.

    Returns
    -------
    low, high : (2, f) float64, corners of the boxes in pixels
    unknown : (f,) bool, True for pieces without a bound
    """
    found = images.found[nodes]
    spots = images.pixel[:, nodes]
    low, high = (end(np.where(found, spots, other), axis=1) for end, other in ((np.min, np.inf), (np.max, -np.inf)))
    room = np.full(nodes.shape[1], ROOM)
    for a, b in WAYS:
        lone = np.flatnonzero(found[a] & ~found[b])
        start = nodes[a, lone]
        way = norm(images.point[:, nodes[b, lone]] - images.point[:, start])
        room[lone] = np.maximum(room[lone], ROOM + way * patch.scale(images.place[:, start], images.distance[start]))
    unknown = ~found.any(axis=0) | ~(room < FAR)
    return low - room, high + room, unknown


def _seeing(patch: Patch, corners: np.ndarray) -> np.ndarray:
    """Return True for triangles (k,) of the patch that may reflect some of the triangles with `corners` (3, 3, n)."""
    if not corners.shape[2]:
        return np.zeros(len(patch), dtype=bool)
    corner = patch.cameras.corners
    cones = Cones.round(patch.cameras.places[:, corner] - patch.eye[:, :, None], patch.cameras.rays[:, corner], WIDER)
    turning = np.flatnonzero(cones.sine > TURNING)
    place, ray = (part.reshape(3, len(turning), len(PROBES)) for part in patch.leaving(
        np.repeat(turning, len(PROBES)), np.tile(np.array(PROBES).T, (1, len(turning)))))
    probed = Cones.round(place[:, :, :3], ray, WIDER)
    for field in fields(Cones):
        getattr(cones, field.name)[..., turning] = getattr(probed, field.name)
    positions = np.ascontiguousarray(corners.transpose(2, 1, 0)).reshape(-1, 3)
    tree = SceneTree.of_ordered(TriangleMesh(positions, np.arange(len(positions)).reshape(-1, 3)))
    return mask(len(patch), tree.trace(cones)[0])


@np.errstate(all="ignore")  # vertices out of the range of floats get no image, and their triangles are left
def whole_faces(cameras: Cameras, eligible: np.ndarray, met: SceneAndMirrors, reach: float, settings: Settings,
                most: int) -> WholeFaces | None:
    """Find the triangles of a scene that can be drawn unclipped, and the pieces that are left to cameras.

    Parameters
    ----------
    cameras : Cameras
    eligible : (n,) bool, True for cameras that are entire triangles of the mirror and show no mirror
    met : SceneAndMirrors, with a scene of triangles
    reach : float, upper bound on the length of paths, in scene units
    settings : Settings
    most : int, largest number of pieces

    Returns
    -------
    WholeFaces or None
        None if no part of the mirror shows such triangles, or too few to be worth it.
    """
    tree = met.scene
    positions, triangles = tree.mesh.positions, tree.mesh.triangles
    if not LEAST_TRIANGLES <= len(triangles) <= most or speck(cameras.view, tree.spheres[0][:, 0]):
        return None
    patch = Patch.largest(cameras, eligible)
    if patch is not None:
        near, large = contacts(patch, met)
        if large.any():
            patch = Patch.largest(cameras, eligible & ~np.isin(cameras.face, patch.face[large]))
    if patch is None or len(patch) < LEAST_PATCH or not _worth_it(cameras, patch):
        return None
    # merge nothing for lamps, so that all lit surfaces remain
    least = 0.0 if isinstance(cameras.view, LampView) else TOGETHER * settings.tolerance
    merged = Merged.of(patch, tree, least, ~met.opacities.stops_light(np.arange(len(triangles))))
    images = merged.images
    seen = images.place[:, images.found]
    size = float(np.ptp(seen, axis=1).max()) if seen.shape[1] else 0.0
    sinking = Sinking(patch, settings.placement == "LAYERED", size, reach, met.slide)
    division = Division(patch, FACE_SHARE * settings.tolerance, sinking, settings.placement == "VIRTUAL", most)
    pieces, behind = shown_or_behind(images, Pieces.of(merged.triangles[merged.left], merged.left), met.outward)
    breathe()
    images, pieces, straying, limited = division.divided(images, pieces)
    shown = np.flatnonzero(whole(patch, images, pieces))
    breathe()
    if sinking.layered:
        shown = shown[~sinking.sunk(images, pieces.nodes[:, shown])]
    shown = shown[~division.strays_inside(images, pieces.nodes[:, shown])]
    breathe()
    near = rows(positions[triangles[near].T])
    layers = Layers(images, sinking, met.opacities)
    drawn, left = drawn_or_left(layers, pieces, shown, behind, near)
    if met.outward is not None:
        away = turned_away(images, pieces, met.outward[pieces.source])
        drawn, left = drawn & ~away, left & ~away
    hidden = len(merged.left) - len(np.unique(pieces.source)) + int((~drawn & ~left).sum())
    return WholeFaces(positions, patch, images, None if merged.triangles is triangles else merged.triangles, pieces,
                      drawn, left, hidden, straying, limited)
