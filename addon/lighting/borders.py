"""Pixels that results cover in part: what they alone show there, and how that goes on beyond them."""
from __future__ import annotations

import numpy as np

from ...core import breathe
from ..rendering import continued

SEEN_WHOLE = 0.995  # of a pixel: coverage from which it shows nothing else
SEEN_PARTLY = 0.25  # from which what lies beside can be taken away from it
UNSEEN = 0.002
UNSURE = 0.04     # of a pixel: by how much coverage, and the light beside, may be wrong
BRIGHTEST_GAP = 2.0  # times what results show beside a gap that is thinner than a pixel


def without_what_lies_beside(light: np.ndarray, coverage: np.ndarray, opacity: np.ndarray,
                             rings: int) -> tuple[np.ndarray, np.ndarray]:
    """What results show in pixels that they cover in part, where the light beside them, continued for a filter's width
    of `rings`, tells, as near to what they show within as that leaves open: beside a lamp it leaves much; and which
    pixels (height, width) are known so.

    In a gap that is thinner than a pixel, be it one before a lamp, no such light is near, and what lies on its other
    side may be very different: there what results show goes on as it is within, as far as something between darkness
    and twice as bright a light in the gap allows.
    """
    border = (coverage > UNSEEN) & (coverage < SEEN_WHOLE)
    apart = (coverage <= UNSEEN) & (opacity > UNSEEN)
    breathe()
    both = np.concatenate((light, opacity[..., None]), axis=2)
    breathe()
    beside, told = continued(both, apart, border, rings)
    breathe()
    within, inner = continued(light, coverage >= SEEN_WHOLE, border, rings)
    breathe()
    alone = light.copy()
    # row after row: few have a border, and a row stays in the cache
    for row in np.flatnonzero(border.any(axis=1)):
        breathe()
        share = np.maximum(coverage[row], SEEN_PARTLY)[:, None]
        other = np.maximum(opacity[row, :, None] - share, 0.0)
        bright = beside[row, :, :3] / np.maximum(beside[row, :, 3:], UNSEEN)
        most = light[row] / share
        guess = np.clip(within[row], most - BRIGHTEST_GAP * other / share * within[row], most)
        exact, open_ = most - other * bright / share, UNSURE * bright / share
        near = np.where(inner[row, :, None], np.clip(within[row], exact - open_, exact + open_), exact)
        # what is brighter than all of the pixel is not what lies beside in it
        sound = told[row] & (exact + open_ >= 0.0).all(axis=1)
        shown = np.where(sound[:, None], np.maximum(near, 0.0), guess)
        alone[row, border[row]] = shown[border[row]]
    return alone, coverage > SEEN_PARTLY


def filled(picture: np.ndarray, known: np.ndarray, needed: np.ndarray) -> np.ndarray:
    """The picture with its unknown pixels, where needed, as the known ones around them, ring by ring."""
    return continued(picture, known, needed, max(known.shape))[0] if known.any() else picture
