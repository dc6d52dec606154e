"""Whole faces: triangles that the patch of a mirror shows whole, drawn from the images of their vertices."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, picture_areas
from ..culling import ScenePieces
from ..geometry import TriangleMesh, norm
from ..patches import Patch, speck
from ..support import FACE_SHARE, Settings, breathe
from ..trees import Cones, SceneTree
from ..views import box
from .contacts import contacts
from .division import Division
from .images import Images
from .layers import Layers
from .pieces import Pieces, whole
from .sinking import Sinking

LEAST_TRIANGLES, LEAST_PATCH = 8000, 32  # of the scene, and of the mirror: fewer are cut sooner than looked at twice
LEAST_SHARE = 0.25  # of what is seen of the mirror: a smaller patch is not worth it
SMALL, MANY = 4.0, 50_000  # pixels: images of edges bend less; how many faces are worth a look before the others
ROOM, FAR = 2.0, 64.0  # pixels round a piece; by which edges that leave the patch may be longer
WAYS = ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2))  # from corner to corner of a triangle
PROBES = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (1 / 3, 1 / 3))
WIDER = 1.25  # than the rays of a triangle at its probes: those between them


@dataclass(frozen=True)
class WholeFaces:
    """What needs no cameras, and what is left for them.

    Attributes
    ----------
    positions : (n, 3) float64, of the scene's vertices
    patch : Patch
    images : Images
        Of the scene's vertices, and behind them of nodes that its triangles were split at.
    pieces : Pieces
        Of all triangles.
    drawn, left : (f,) bool
        Which of the pieces are drawn, and which are left for the cameras of the patch; nearer ones hide the others.
    hidden : int
        How many are hidden, of these and of pieces that are not told.
    straying : (2, e) float64
        By how many pixels edges stray, and over how many.
    limited : int
        Edges that were not split since there would be too many pieces.
    """

    positions: np.ndarray
    patch: Patch
    images: Images
    pieces: Pieces
    drawn: np.ndarray
    left: np.ndarray
    hidden: int
    straying: np.ndarray
    limited: int

    def scene_pieces(self) -> ScenePieces:
        """What is left to the cameras of the patch."""
        pieces, patch, points = self.pieces.select(self.left), self.patch, self.images.point
        on_patch, open_ = (np.zeros(len(patch.mirror_map.surface), dtype=bool) for _ in range(2))
        on_patch[patch.face] = True
        low, high, unknown = _boxes(patch, self.images, pieces.nodes)
        cells = patch.border.unmarked().with_boxes(low[:, ~unknown], high[:, ~unknown])
        open_[patch.face[_seeing(patch, points[:, pieces.nodes[:, unknown]])]] = True
        positions = np.concatenate((self.positions, (points[:, len(self.positions):] + patch.eye).T))
        return ScenePieces(TriangleMesh(positions, pieces.nodes.T), pieces.source, on_patch, cells, open_)


def _worth_it(cameras: Cameras, patch: Patch) -> bool:
    """Whether the patch is a good part of what is seen of the mirror."""
    areas = picture_areas(cameras)
    return bool(areas[np.isin(cameras.face, patch.face)].sum() > LEAST_SHARE * areas.sum())


def _beyond(patch: Patch, images: Images, nodes: np.ndarray) -> np.ndarray:
    """Which pieces (3, f), all with three images, lie outside of the picture."""
    low, high = box(images.pixel[:, nodes])
    return ((high < -ROOM) | (low > np.array(patch.view.resolution)[:, None] + ROOM)).any(axis=0)


def _over_what_goes_through(patch: Patch, images: Images, nodes: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Which of the `faces` (n,) among pieces (3, f) lie over several triangles of the mirror where pieces are seen that
    go through it: these may lie closer behind them than they sink."""
    found, ahead = images.found[nodes], images.distance[nodes] > 0.0
    boxes: list[tuple[np.ndarray, np.ndarray]] = []
    for a, b in WAYS:
        through = np.flatnonzero(found[a] & ~found[b] & ~ahead[b])
        if not len(through):
            continue
        start, end = nodes[a, through], nodes[b, through]
        images.moved(patch, start)
        way = images.point[:, end] - images.point[:, start]
        spot = images.pixel[:, start]
        other = spot + np.clip((images.moving[:, :, start] * way).sum(axis=1), -FAR, FAR)
        boxes.append((np.minimum(spot, other) - ROOM, np.maximum(spot, other) + ROOM))
    if not boxes:
        return np.zeros(len(faces), dtype=bool)
    cells = patch.border.unmarked().with_boxes(*(np.concatenate(side, axis=1) for side in zip(*boxes)))
    return images.several(nodes[:, faces]) & cells.touched(*box(images.pixel[:, nodes[:, faces]]))


def _boxes(patch: Patch, images: Images, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes (2, f) in the picture, from `low` to `high`, in which the images of pieces (3, f) lie; of which pieces
    nothing is known."""
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
    """Which triangles (k,) of the patch may see some of the triangles with `corners` (3, 3, n), from the eye."""
    if not corners.shape[2]:
        return np.zeros(len(patch), dtype=bool)
    member = np.repeat(np.arange(len(patch)), len(PROBES))
    uv = np.tile(np.array(PROBES).T, (1, len(patch)))
    place, ray = (part.reshape(3, len(patch), -1) for part in patch.leaving(member, uv))
    cones = Cones.round(place[:, :, :3], ray, WIDER)
    positions = np.ascontiguousarray(corners.transpose(2, 1, 0)).reshape(-1, 3)
    tree = SceneTree.of_ordered(TriangleMesh(positions, np.arange(len(positions)).reshape(-1, 3)))
    seeing = np.zeros(len(patch), dtype=bool)
    seeing[tree.trace(cones)[0]] = True
    return seeing


def _without_hidden(patch: Patch, images: Images, pieces: Pieces, sinking: Sinking) -> Pieces:
    """The pieces without those that others hide, where many are so small that none is divided before that is told."""
    found = images.found[pieces.nodes]
    small = np.flatnonzero(found[0] & found[1] & found[2])
    low, high = box(images.pixel[:, pieces.nodes[:, small]])
    small = small[(high - low).max(axis=0) < SMALL]
    if len(small) < MANY:
        return pieces
    small = small[whole(patch, images, pieces.select(small))]
    kept = np.ones(len(pieces), dtype=bool)
    kept[small] = ~Layers(patch, images, sinking).hidden(pieces.nodes[:, small])
    return pieces.select(kept)


@np.errstate(all="ignore")  # what is too large or too small to be told has no image, and is left
def whole_faces(cameras: Cameras, eligible: np.ndarray, tree: SceneTree, reach: float, settings: Settings,
                most: int) -> WholeFaces | None:
    """The whole faces of a scene, and what they leave to cameras.

    Parameters
    ----------
    cameras : Cameras
    eligible : (n,) bool
        Cameras that are triangles of the mirror whole, and show no mirror.
    tree : SceneTree
    reach : float
        Length of the longest path that there may be, in scene units.
    settings : Settings
    most : int
        Pieces that there may be.

    Returns
    -------
    WholeFaces or None
        None where no part of the mirror may show any, or too few to be worth it.
    """
    positions, triangles, areal = tree.mesh.positions, tree.mesh.triangles, np.sort(tree.order)
    if not LEAST_TRIANGLES <= len(triangles) <= most or speck(cameras.view, tree.spheres[0][:, 0]):
        return None
    patch = Patch.largest(cameras, eligible)
    if patch is not None:
        near, large = contacts(patch, tree)
        if large.any():
            patch = Patch.largest(cameras, eligible & ~np.isin(cameras.face, patch.face[large]))
    if patch is None or len(patch) < LEAST_PATCH or not _worth_it(cameras, patch):
        return None
    used = np.zeros(len(positions), dtype=bool)
    used[triangles[areal]] = True
    images = Images.of(patch, np.where(used, positions.T, np.nan) - patch.eye)
    seen = images.place[:, images.found]
    size = float(np.ptp(seen, axis=1).max()) if seen.shape[1] else 0.0
    sinking = Sinking(settings.placement == "LAYERED", size, reach)
    division = Division(patch, FACE_SHARE * settings.tolerance, sinking, settings.placement == "VIRTUAL", most)
    pieces = Pieces.of(triangles[areal], areal)
    breathe()
    pieces = _without_hidden(patch, images, pieces, sinking)
    breathe()
    images, pieces, straying, limited = division.divided(images, pieces)
    breathe()
    shown = np.flatnonzero(whole(patch, images, pieces))
    breathe()
    if sinking.layered:
        shown = shown[~sinking.sunk(patch, images, pieces.nodes[:, shown])]
    shown = shown[~division.strays_inside(images, pieces.nodes[:, shown])]
    breathe()
    found = images.found[pieces.nodes]
    found = np.flatnonzero(found[0] & found[1] & found[2])
    found = found[~_beyond(patch, images, pieces.nodes[:, found])]
    breathe()
    drawn, left = np.zeros(len(pieces), dtype=bool), np.ones(len(pieces), dtype=bool)
    drawn[shown] = True
    left[shown] = False
    drawn &= np.isin(np.arange(len(pieces)), found)
    layers = Layers(patch, images, sinking)
    corners = np.moveaxis(positions[triangles[near]], 2, 0).swapaxes(1, 2)
    hidden, close = layers.hidden_and_close(pieces.nodes[:, found], drawn[found], corners)
    breathe()
    drawn[found] &= ~hidden & ~close
    left[found] |= close
    over = np.flatnonzero(drawn)
    over = over[_over_what_goes_through(patch, images, pieces.nodes, over)]
    breathe()
    drawn[over], left[over] = False, True
    gone = len(areal) - len(np.unique(pieces.source))
    return WholeFaces(positions, patch, images, pieces, drawn, left, gone + int((~drawn & ~left).sum()), straying,
                      limited)
