"""Pixels that results cover in part: what they alone show there, and how that goes on beyond them."""
from __future__ import annotations

import numpy as np

from ....core import breathe
from ...rendering import continued, grown, sum_around

SEEN_WHOLE = 0.995  # of a pixel: coverage from which it shows nothing else
SEEN_PARTLY = 0.25  # from which what lies beside can be taken away from it
UNSEEN = 0.002
UNSURE = 0.04     # of a pixel: by how much coverage, and the light beside, may be wrong
BRIGHTEST_GAP = 2.0  # times what results show beside a gap that is thinner than a pixel
LAMP = 4.0        # light of what may be a lamp, where that is no more than white
SPILT = 2.0       # times what results show farther within, beside a lamp: what is brighter is that one's light
SPREAD = 3        # pixels as far as which filters bring it
DAZZLING = 16.0   # times what may be a lamp: in pixels that results cover a part of, what is less bright is their rim


def without_what_lies_beside(light: np.ndarray, coverage: np.ndarray, opacity: np.ndarray,
                             rings: int, thin_too: bool = True,
                             lamp: float = np.inf) -> tuple[np.ndarray, np.ndarray]:
    """What results show in pixels that they cover in part, where the light beside them, continued for a filter's width
    of `rings`, tells, as near to what they show within as that leaves open: beside a lamp it leaves much; and which
    pixels (height, width) are known so.

    In a gap that is thinner than a pixel, be it one before a lamp, no such light is near, and what lies on its other
    side may be very different: there what results show goes on as it is within, as far as something between darkness
    and twice as bright a light in the gap allows. What is so thin that no pixel shows much of it shows, with
    `thin_too`, what all the pixels around have of it together. What is brighter than farther within, beside a lamp that
    is brighter than `lamp`, is unknown.
    """
    spilt = _spilt(light, coverage, lamp, UNSEEN if thin_too else SEEN_PARTLY)
    border = (coverage > UNSEEN) & (coverage < SEEN_WHOLE)
    apart = (coverage <= UNSEEN) & (opacity > UNSEEN)
    breathe()
    both = np.concatenate((light, opacity[..., None]), axis=2)
    breathe()
    beside, told = continued(both, apart, border, rings)
    breathe()
    within, inner = continued(light, (coverage >= SEEN_WHOLE) & ~spilt, border, rings)
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
    known = coverage > SEEN_PARTLY
    thin = border & ~grown(known, 1) if thin_too else np.zeros_like(known)
    if thin.any():
        breathe()
        together, enough = _together(light, coverage, opacity, beside, told | (coverage >= SEEN_WHOLE))
        thin &= enough
        alone[thin], known = together[thin], known | thin
    return alone, known & ~spilt


def _spilt(light: np.ndarray, coverage: np.ndarray, lamp: float, beside: float) -> np.ndarray:
    """Pixels (height, width) in which the light is that of lamps beside, spilt by the filter: a pixel of which a
    thousandth lies outside is white beside one that is a thousand times white. It is no part of what results show where
    no pixel around that they cover whole is nearly as bright. The lamp may be thinner than a pixel, and then be seen in
    no pixel of which they cover no more than `beside`: so may a rim of what they show, but that does not dazzle."""
    bright, whole = light.max(axis=2), coverage >= SEEN_WHOLE
    breathe()
    outside = np.where((coverage <= beside) | ~whole & (bright > DAZZLING * lamp), bright, 0.0)
    if outside.max(initial=0.0) <= lamp:
        return np.zeros(bright.shape, dtype=bool)
    outside, inside = (brightest(part) for part in (outside, np.where(whole, bright, 0.0)))
    near = (outside > lamp) & (outside > SPILT * inside)
    breathe()
    within, told = continued(bright[..., None], whole & ~near, near, 2 * SPREAD + 1)
    return near & (bright > np.where(told, SPILT * within[..., 0], lamp))


def brightest(bright: np.ndarray) -> np.ndarray:
    """The brightest of all pixels (height, width) as near as a filter reaches."""
    for axis in (0, 1):
        breathe()
        around = np.pad(bright, [(SPREAD, SPREAD) if axis == side else (0, 0) for side in (0, 1)])
        bright = np.lib.stride_tricks.sliding_window_view(around, 2 * SPREAD + 1, axis=axis).max(axis=2)
    return bright


def _together(light: np.ndarray, coverage: np.ndarray, opacity: np.ndarray, beside: np.ndarray,
              told: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What each pixel and its neighbours show of results in the mean, and which have enough of them to tell."""
    bright = beside[..., :3] / np.maximum(beside[..., 3:], UNSEEN)
    breathe()
    own = light - np.maximum(opacity - coverage, 0.0)[..., None] * bright
    breathe()
    whole = sum_around(np.where(told[..., None], own, 0.0))
    breathe()
    amount = sum_around(np.where(told, coverage, 0.0))
    return np.maximum(whole, 0.0) / np.maximum(amount, UNSEEN)[..., None], amount > SEEN_PARTLY


def filled(picture: np.ndarray, known: np.ndarray, needed: np.ndarray) -> np.ndarray:
    """The picture with its unknown pixels, where needed, as the known ones around them, ring by ring."""
    return continued(picture, known, needed, max(known.shape))[0] if known.any() else picture
