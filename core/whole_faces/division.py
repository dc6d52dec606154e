"""Division: pieces are split until they can be drawn unclipped, are straight enough, or too small.

Edges of the scene have curved images: an edge whose middle deviates from the chord gets a node there. Triangles over
the border of the patch are split into small pieces, so that little is left to cameras. A decision about an edge holds
for the faces on both its sides.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import distinct, doubled_areas, edge_numbers, mask, next_corner, numbered
from ..patches import Patch
from ..support import DOUBT_SHARE, WHOLE_OUTLINE_SHARE, breathe
from .images import Images
from .pieces import Pieces, whole
from .sinking import Sinking, sides

LEVELS = 10
DICED = 48.0  # pixels: longer edges of triangles over the border are split
DEEP = 6.0  # pixels: shorter edges that sink too deep are left to cameras
SHORTEST = 0.25  # pixels: the deviation of edges up to this length is invisible


@dataclass(frozen=True)
class Division:
    """Adaptive division of pieces until their edges follow their true images.

    Attributes
    ----------
    patch : Patch
    tolerance : float, largest deviation of edges inside a surface, in pixels
    sinking : Sinking
    virtual : bool, True if faces are drawn at the virtual image's depth
    most : int, largest number of pieces
    """

    patch: Patch
    tolerance: float
    sinking: Sinking
    virtual: bool
    most: int

    def depths(self, images: Images, node: np.ndarray) -> np.ndarray:
        """Return the depths (n,) at which nodes are drawn, to interpolate along edges in perspective.

        A node is a source point with its image: `node` (n,) are columns of `images`. The depth is the distance in scene
        units from the eye's plane to the node's place on the mirror, or to its virtual image if `virtual`. It is at
        least 1e-300, and 1 for all nodes in an orthographic view.
        """
        if self.patch.mirror_map.orthographic:
            return np.ones(len(node))
        place = images.place[:, node] * ((1.0 + images.distance[node]) if self.virtual else 1.0)
        return np.maximum(self.patch.view.depths((place + self.patch.eye).T), 1e-300)

    def divided(self, images: Images, pieces: Pieces) -> tuple[Images, Pieces, np.ndarray, int]:
        """Split pieces until their edges deviate by less than the tolerance.

        Returns
        -------
        images : Images, the given ones, then those of new nodes
        pieces : Pieces
        straying : (2, e) float64, deviation and length of the edges that were examined and not split, in pixels
        limited : int, number of edges that were not split because there would be too many pieces
        """
        finished, left, limited = [], [np.zeros((2, 0))], 0
        for _ in range(LEVELS):
            breathe()
            # keep pieces none of whose edges may have to be split
            asked = self._asked(images, pieces)
            breathe()
            some = asked[0] | asked[1] | asked[2]
            finished.append(pieces.select(~some))
            pieces, asked = pieces.select(some), asked[:, some]
            breathe()
            if not len(pieces):
                continue
            side, face = np.nonzero(asked)
            one, other = pieces.nodes[side, face], pieces.nodes[next_corner(side), face]
            count = len(images)
            keys, edge = distinct(edge_numbers(one, other, count))
            over = mask(len(keys), edge[~whole(self.patch, images, pieces)[face]])
            breathe()
            outline = _outlines(images, pieces, face, edge, len(keys))
            ends = keys // count, keys % count
            images = images.moved(self.patch, *ends)
            breathe()
            marked, lost, straying, middles = self._judged(images, *ends, over, outline)
            left.append(straying)
            if sum(map(len, finished)) + len(pieces) + 2 * len(middles) > self.most:
                limited = len(middles)
                finished.append(pieces)
                break
            new = numbered(len(keys), marked, count)
            images = Images.joined((images, middles))
            breathe()
            middle = np.full(pieces.nodes.shape, -1)
            middle[side, face] = new[edge]
            pieces.lost[side, face] |= lost[edge]
            pieces.done[side, face] = True
            divided = middle.max(axis=0) >= 0
            finished.append(pieces.select(~divided))
            pieces = pieces.select(divided).split(middle[:, divided])
        else:
            finished.append(pieces)
        return images, Pieces.joined(finished), np.concatenate(left, axis=1), limited

    def strays_inside(self, images: Images, nodes: np.ndarray) -> np.ndarray:
        """Return True for faces with corners `nodes` (3, f) whose centre deviates by more than the tolerance.

        Only faces over several mirror triangles are tested: the map has kinks there that their edges may not show.
        """
        chosen = np.flatnonzero(images.several(nodes))
        corners = nodes[:, chosen]
        images = images.moved(self.patch, *corners)
        breathe()
        bent = np.zeros(len(chosen))
        for a, b in sides(corners):
            bent = np.maximum(bent, self._seems(images, a, b)[0])
        asked = bent > DOUBT_SHARE * self.tolerance
        chosen, corners = chosen[asked], corners[:, asked]
        depth = np.stack([self.depths(images, corner) for corner in corners])
        drawn = (images.pixel[:, corners] * depth).sum(axis=1) / depth.sum(axis=0)
        middles = images.around(self.patch, corners)
        found = np.zeros(nodes.shape[1], dtype=bool)
        found[chosen] = ~middles.found | (np.hypot(*(middles.pixel - drawn)) > self.tolerance)
        return found

    def _seems(self, images: Images, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, ...]:
        """Estimate the deviation of the images of edges from their chords, by the derivatives of the map at their ends.

        Parameters
        ----------
        a, b : (e,) int64, nodes at the ends of the edges

        Returns
        -------
        straying : (e,) float64, pixels
        chord : (2, e) float64, pixels from a to b
        moved : (2, e) float64, derivative at a of the image along the edge, in pixels
        share : (e,) float64, of the chord, from a to the image of the edge's middle
        """
        along = images.point[:, b] - images.point[:, a]
        chord = images.pixel[:, b] - images.pixel[:, a]
        moved, back = ((images.moving[:, :, end] * along).sum(axis=1) for end in (a, b))
        near, far = (self.depths(images, end) for end in (a, b))
        # a cubic's deviation from its chord is a quarter of the difference between chord and derivative at an end
        straying = 0.25 * np.maximum(np.hypot(*(moved - far / near * chord)), np.hypot(*(back - near / far * chord)))
        return straying, chord, moved, far / (near + far)

    def _asked(self, images: Images, pieces: Pieces) -> np.ndarray:
        """Return True for edges (3, f) of the pieces that may have to be split."""
        found, spots = images.found[pieces.nodes], images.pixel[:, pieces.nodes]
        some, asked = found[0] | found[1] | found[2], np.empty(found.shape, dtype=bool)
        for k in range(3):
            there = next_corner(k)
            both = found[k] & found[there]
            away = np.maximum(*np.abs(spots[:, k] - spots[:, there]))
            long = away > 2.0 * WHOLE_OUTLINE_SHARE * self.tolerance
            asked[k] = (both & long) | (some & (found[k] != found[there]))
        return asked & ~pieces.done

    def _judged(self, images: Images, a: np.ndarray, b: np.ndarray, over: np.ndarray,
                outline: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Images]:
        """Decide which edges to split.

        Parameters
        ----------
        a, b : (e,) int64, nodes at the ends of the edges
        over : (e,) bool, True for edges of pieces that are not whole on the patch
        outline : (e,) bool, True for outlines

        Returns
        -------
        marked : (e,) bool, True for edges to split
        lost : (e,) bool, True for edges whose middle has no image
        strayed : (2, k) float64, deviation and length, in pixels, of the edges that stay
        middles : Images, of the middles of the edges to split
        """
        tolerance = np.where(outline, WHOLE_OUTLINE_SHARE, 1.0) * self.tolerance
        a, b = np.where(images.found[a], (a, b), (b, a))
        both = images.found[b]
        straying, chord, moved, share = self._seems(images, a, b)
        breathe()
        length = np.hypot(*np.where(both, chord, moved))
        diced = over & (length > DICED)
        sunk = both & (length > DEEP) & self.sinking.too_deep(images, a, b)
        asked = np.flatnonzero(diced | sunk | (both & (length > SHORTEST) & (straying > DOUBT_SHARE * tolerance)))
        middles = images.between(self.patch, a[asked], b[asked])
        halfway = images.pixel[:, a[asked]] + share[asked] * chord[:, asked]
        found = middles.found & both[asked]
        straying[asked] = np.where(found, np.hypot(*(middles.pixel - halfway)), np.inf)
        marked = diced | sunk
        marked[asked] |= found & (straying[asked] > tolerance[asked])
        lost = np.zeros(len(a), dtype=bool)
        lost[asked] = both[asked] & ~found
        marked &= ~lost | diced
        stay = both & ~marked & ~lost
        return marked, lost, np.stack((straying[stay], length[stay])), middles.select(marked[asked])


def _outlines(images: Images, pieces: Pieces, face: np.ndarray, edge: np.ndarray, count: int) -> np.ndarray:
    """Return True for edges (count,) that are outlines: the surface ends there, or folds over in the picture.

    `face` (k,) and `edge` (k,) are the piece and the edge of each side of a piece.
    """
    found = images.found[pieces.nodes]
    turn = np.where(found[0] & found[1] & found[2], np.sign(doubled_areas(images.pixel[:, pieces.nodes].T)), 0.0)[face]
    return (np.bincount(edge, minlength=count) != 2) | (np.abs(np.bincount(edge, turn, minlength=count)) != 2.0)
