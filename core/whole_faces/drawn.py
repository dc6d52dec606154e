"""What of the pieces is drawn, what is left to cameras, and what nobody sees."""
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
    """The pieces without those that turn away and are too small to be bent; and these, which lie behind others."""
    if outward is None:
        return pieces, pieces.select(slice(0, 0))
    away = np.flatnonzero(turned_away(images, pieces, outward[pieces.source]))
    low, high = box(images.pixel[:, pieces.nodes[:, away]])
    away = away[(high - low).max(axis=0) < SMALL]
    shown = ~mask(len(pieces), away)
    return pieces.select(shown), pieces.select(away)


def drawn_or_left(layers: Layers, pieces: Pieces, shown: np.ndarray, behind: Pieces,
                   near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two masks of the pieces (f,): those that are drawn, of the `shown` (n,) ones, which are whole, and those
    that are left to cameras. `behind` them lie others, and before them triangles of the scene with corners `near`
    (3, 3, t)."""
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
    """Which pieces (3, f), all with three images, lie outside of the picture."""
    low, high = box(images.pixel[:, nodes])
    return ((high < -ROOM) | (low > np.array(patch.view.resolution)[:, None] + ROOM)).any(axis=0)
