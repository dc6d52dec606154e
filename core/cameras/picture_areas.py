"""Picture areas of cameras, which set their priority if limits do not allow to process all."""
from __future__ import annotations

import numpy as np

from ..geometry import distinct, doubled_areas, edge_lengths, following, shared_edges
from .three_ray_cameras import Cameras

LEAST_WORTH = 1.0 / 16.0  # square pixels: added to each camera's area


def picture_areas(cameras: Cameras) -> np.ndarray:
    """Return the priority (n,) of cameras: the area that they cover in pixels, plus a small constant."""
    return LEAST_WORTH + pixels_of(cameras)


def pixels_of(cameras: Cameras) -> np.ndarray:
    """Return the area (n,) of cameras in the picture, in pixels; approximate at the picture's border."""
    return 0.5 * np.abs(doubled_areas(_corners(cameras)))


def pixels_around_faces(cameras: Cameras) -> float:
    """Return the total length, in pixels, of the outlines of the mirror faces' parts that cameras cover.

    Edges between two cameras of one face do not count.
    """
    _, first, edge = shared_edges(cameras.corners)
    face = np.repeat(cameras.face, 3)
    sides = np.bincount(edge.ravel(), minlength=len(first))
    inner = (sides == 2) & (np.bincount(edge.ravel(), face == face[first][edge.ravel()], len(first)) == 2.0)
    return float(edge_lengths(_corners(cameras)).ravel()[~inner[edge.ravel()]].sum())


def pixels_crossed(cameras: Cameras) -> np.ndarray:
    """Return about how many pixels (n,) each camera overlaps, at least one; a sliver overlaps all that it crosses."""
    return np.maximum(pixels_of(cameras) + edge_lengths(_corners(cameras)).max(axis=1), 1.0)


def pixels_held(cameras: Cameras) -> np.ndarray:
    """Return for each camera a number (n,) of the pixel that holds its centroid; used pixels are numbered from 0."""
    width, height = cameras.view.resolution
    x, y = np.minimum(_corners(cameras).mean(axis=1).astype(np.int64).T, ((width - 1,), (height - 1,)))
    return distinct(x + width * y)[1]


def covered_pixels(cameras: Cameras) -> int:
    """Return about how many pixels cameras cover together; a pixel that several cover counts once."""
    return round(float(np.minimum(np.bincount(pixels_held(cameras), pixels_of(cameras)), 1.0).sum()))


def places_at(cameras: Cameras, spots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unproject picture positions onto the planes of cameras.

    Parameters
    ----------
    spots : (n, 2) float64, one position in pixels for each camera

    Returns
    -------
    places : (3, n) float64, in world space; NaN for cameras without an area in the picture
    inside : (n,) bool, True if the place lies in the camera
    """
    view = cameras.view
    ways = view.pixels(cameras.places.T)[cameras.corners] - spots[:, None]
    after = following(ways)
    areas = following(ways[..., 0] * after[..., 1] - ways[..., 1] * after[..., 0])
    turn = np.sign(areas.sum(axis=1, keepdims=True))
    # perspective correction of the barycentric weights
    weights = areas / view.clip(cameras.places.T)[cameras.corners, 3]
    with np.errstate(invalid="ignore", divide="ignore"):
        weights /= weights.sum(axis=1, keepdims=True)
    return ((cameras.places[:, cameras.corners] * weights).sum(axis=2),
            ((areas * turn >= 0.0) & (turn != 0.0)).all(axis=1))


def _corners(cameras: Cameras) -> np.ndarray:
    """Return the corners (n, 3, 2) of the cameras in pixels, clamped to the picture."""
    view = cameras.view
    return np.clip(np.nan_to_num(view.pixels(cameras.places.T)), 0.0, view.resolution)[cameras.corners]
