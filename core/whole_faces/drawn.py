"""Classification of the pieces: drawn unclipped, left to cameras, or invisible."""
from __future__ import annotations

import numpy as np

from ..geometry import mask
from ..patches import Patch
from ..support import breathe
from ..views import box
from .images import Images
from .layers import Layers
from .pieces import Pieces, turned_away

SMALL = 4.0  # pixels: images of edges bend less
ROOM = 2.0  # pixels round a piece


def shown_or_behind(images: Images, pieces: Pieces, outward: np.ndarray | None) -> tuple[Pieces, Pieces]:
    """Separate small pieces that are seen from behind from all others.

    `outward` (m,) is 1 for source triangles that are visible from the front only, 0 for others; None if there are none.

    Returns
    -------
    shown, behind : Pieces, all others, and the small ones that face away and lie behind others
    """
    if outward is None:
        return pieces, pieces.select(slice(0, 0))
    away = np.flatnonzero(turned_away(images, pieces, outward[pieces.source]))
    low, high = box(images.pixel[:, pieces.nodes[:, away]])
    away = away[(high - low).max(axis=0) < SMALL]
    shown = ~mask(len(pieces), away)
    return pieces.select(shown), pieces.select(away)


def drawn_or_left(layers: Layers, pieces: Pieces, shown: np.ndarray, behind: Pieces,
                   near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Decide which pieces (f) are drawn unclipped, and which are left to cameras.

    Parameters
    ----------
    shown : (n,) int64, pieces that are whole on the patch
    behind : Pieces, which lie behind these
    near : (3, 3, t) float64, corners of scene triangles that may hide the patch closely

    Returns
    -------
    drawn, left : (f,) bool
    """
    patch, images = layers.sinking.patch, layers.images
    found = images.found[pieces.nodes]
    found = np.flatnonzero(found[0] & found[1] & found[2])
    found = found[~_beyond(patch, images, pieces.nodes[:, found])]
    breathe()
    drawn = mask(len(pieces), shown)
    left = ~drawn
    drawn &= mask(len(pieces), found)
    nodes = np.concatenate((pieces.nodes[:, found], behind.nodes), axis=1)
    source = np.concatenate((pieces.source[found], behind.source))
    solid = np.zeros(nodes.shape[1], dtype=bool)
    solid[:len(found)] = drawn[found]
    hidden, close = (told[:len(found)] for told in layers.hidden_and_close(nodes, source, solid, near))
    drawn[found] &= ~hidden & ~close
    left[found] |= close
    return drawn, left


def _beyond(patch: Patch, images: Images, nodes: np.ndarray) -> np.ndarray:
    """Return True for pieces with corners `nodes` (3, f), all of which have images, that lie outside the picture."""
    low, high = box(images.pixel[:, nodes])
    return ((high < -ROOM) | (low > np.array(patch.view.resolution)[:, None] + ROOM)).any(axis=0)
