"""Where cameras lie in the picture, and how much they cover: what they are worth where not all can be looked at."""
from __future__ import annotations

import numpy as np

from ..geometry import distinct, doubled_areas, edge_lengths, following, shared_edges
from .three_ray_cameras import Cameras

LEAST_WORTH = 1.0 / 16.0  # square pixels: no camera counts for less


def picture_areas(cameras: Cameras) -> np.ndarray:
    """What cameras (n,) are worth: the pixels that they cover, and a little more."""
    return LEAST_WORTH + pixels_of(cameras)


def pixels_of(cameras: Cameras) -> np.ndarray:
    """About how many pixels of the picture cameras (n,) cover."""
    return 0.5 * np.abs(doubled_areas(_corners(cameras)))


def pixels_around_faces(cameras: Cameras) -> float:
    """About how many pixels long the ways round the parts of the mirror's faces are that cameras lie on: an edge
    between two cameras of one face is none of them."""
    _, first, edge = shared_edges(cameras.corners)
    face = np.repeat(cameras.face, 3)
    sides = np.bincount(edge.ravel(), minlength=len(first))
    inner = (sides == 2) & (np.bincount(edge.ravel(), face == face[first][edge.ravel()], len(first)) == 2.0)
    return float(edge_lengths(_corners(cameras)).ravel()[~inner[edge.ravel()]].sum())


def pixels_crossed(cameras: Cameras) -> np.ndarray:
    """About how many pixels (n,), one at least, what lies in cameras is spread over: in a sliver over those that it
    crosses."""
    return np.maximum(pixels_of(cameras) + edge_lengths(_corners(cameras)).max(axis=1), 1.0)


def pixels_held(cameras: Cameras) -> np.ndarray:
    """The pixels (n,) that hold the middles of cameras, numbered from 0."""
    width, height = cameras.view.resolution
    x, y = np.minimum(_corners(cameras).mean(axis=1).astype(np.int64).T, ((width - 1,), (height - 1,)))
    return distinct(x + width * y)[1]


def covered_pixels(cameras: Cameras) -> int:
    """About how many pixels of the picture cameras cover together, each pixel once."""
    return round(float(np.minimum(np.bincount(pixels_held(cameras), pixels_of(cameras)), 1.0).sum()))


def places_at(cameras: Cameras, spots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (3, n) that the eye sees on the planes of cameras at spots (n, 2) of the picture, not numbers on cameras
    without an area, and whether they lie in the cameras."""
    view = cameras.view
    ways = view.pixels(cameras.places.T)[cameras.corners] - spots[:, None]
    after = following(ways)
    areas = following(ways[..., 0] * after[..., 1] - ways[..., 1] * after[..., 0])
    turn = np.sign(areas.sum(axis=1, keepdims=True))
    # straight lines in the picture are straight on the mirror, but not as long
    weights = areas / view.clip(cameras.places.T)[cameras.corners, 3]
    with np.errstate(invalid="ignore", divide="ignore"):
        weights /= weights.sum(axis=1, keepdims=True)
    return ((cameras.places[:, cameras.corners] * weights).sum(axis=2),
            ((areas * turn >= 0.0) & (turn != 0.0)).all(axis=1))


def _corners(cameras: Cameras) -> np.ndarray:
    """Corners (n, 3, 2) of the cameras in pixels, those beyond the picture on its border."""
    view = cameras.view
    return np.clip(np.nan_to_num(view.pixels(cameras.places.T)), 0.0, view.resolution)[cameras.corners]
