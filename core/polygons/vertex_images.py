"""Images of the diffuse vertices in the cameras: the cubic's roots, brought onto the true reflection map."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..culling import Candidates
from ..geometry import ColumnArrays, between, ranges
from ..solver import project
from ..support import breathe
from ..trees import Cones

SAME_IMAGE = 1e-3  # pixels: closer images of one vertex are one image, found from both sides of a shared edge
ROWS = 2.0**20  # rows of `NEAR_IMAGE` pixels above and below the picture's origin; images beyond share the last row
NEAR_IMAGE = 3.0  # pixels: how far the straight outlines of the clip may put a vertex from its image


@dataclass(frozen=True)
class VertexImages(ColumnArrays):
    """Images of source vertices in cameras, sorted by vertex, except those of `images_of_pairs`.

    The image of a vertex P is the place Q on the first mirror at which the eye sees it: P = O + s R, with the origin O
    and the direction R of the ray that leaves the last mirror. After one bounce O = Q.

    Attributes
    ----------
    vertex : (n,) int64, source vertex, as index into the positions for which images were computed
    camera : (n,) int64, camera in which the image was found
    distance : (n,) float64
        s, a multiple of the length of the path from the eye to O. It is a length for an orthographic view, and for maps
        with unit rays.
    place : (3, n) float64, Q in world space
    pixel : (2, n) float64, Q in the picture, in pixels to the right and up
    """

    vertex: np.ndarray
    camera: np.ndarray
    distance: np.ndarray
    place: np.ndarray
    pixel: np.ndarray

    def nearest(self, vertex: np.ndarray, camera: np.ndarray, pixel: np.ndarray) -> np.ndarray:
        """Return the index (n,) of the image that is nearest to each guess, -1 if none is within `NEAR_IMAGE` pixels.

        Images in the same camera come before those in other cameras.

        Parameters
        ----------
        vertex, camera : (n,) int64, of the guesses
        pixel : (2, n) float64
        """
        # a crumpled mirror shows a vertex thousands of times: compare only images in nearby rows of the picture
        rows_of, asked = (np.floor(np.clip(spots[1] / NEAR_IMAGE, -ROWS, ROWS)) for spots in (self.pixel, pixel))
        key, wanted = (of * 4.0 * ROWS + row for of, row in ((self.vertex, rows_of), (vertex, asked)))
        breathe()
        order = np.argsort(key, kind="stable")
        breathe()
        key = key[order]
        start, count = between(key, wanted - 1.0, wanted + 1.0)
        breathe()
        image, guess = ranges(start, count)
        image = order[image]
        away = np.linalg.norm(self.pixel[:, image] - pixel[:, guess], axis=0)
        breathe()
        own = self.camera[image] == camera[guess]
        meant = away < NEAR_IMAGE
        guess, image, away, own = guess[meant], image[meant], away[meant], own[meant]
        breathe()
        order = np.lexsort((image, away, ~own, guess))
        breathe()
        found, first = np.unique(guess[order], return_index=True)
        result = np.full(len(vertex), -1)
        result[found] = image[order[first]]
        return result


def vertex_images(candidates: Candidates) -> tuple[VertexImages, dict]:
    """Compute the images of the candidate triangles' vertices, each in the cameras of its candidates.

    Returns
    -------
    images : VertexImages
    counts : dict, pairs solved, roots found, images kept
    """
    cameras, frames = candidates.cameras, candidates.frames
    positions = frames.positions
    vertices = frames.vertices[:, candidates.column]
    key = np.unique((candidates.camera * len(positions) + vertices).ravel())
    camera, vertex = key // len(positions), key % len(positions)
    points = positions[vertex].T
    touching = Cones.around(cameras).touch(camera, points, np.zeros(len(camera)))
    images, counts, _ = images_of_pairs(cameras, positions, camera[touching], vertex[touching])
    images = images.select(np.lexsort((images.camera, images.vertex)))
    images = images.select(~repeated(images.vertex, images.pixel.T))
    counts["images"] = len(images.vertex)
    return images, counts


def images_of_pairs(cameras: Cameras, positions: np.ndarray, camera: np.ndarray,
                    vertex: np.ndarray) -> tuple[VertexImages, dict, np.ndarray]:
    """Compute the images in pairs of a `camera` (k,) and a `vertex` (k,), not sorted.

    An image on an edge that two cameras share is found in both.

    Returns
    -------
    images : VertexImages
    counts : dict, pairs solved, roots found
    pair : (n,) int64, index of the pair that each image was found in
    """
    view, mirror_map = cameras.view, cameras.mirror_map
    corners = cameras.corners[camera]
    found = project(np.moveaxis(cameras.origins[:, corners], 0, 2), np.moveaxis(cameras.rays[:, corners], 0, 2),
                    positions[vertex])
    counts = {"projections": len(camera), "roots": len(found.pair)}
    camera, vertex = camera[found.pair], vertex[found.pair]
    guess = (cameras.places[:, cameras.corners[camera]] * found.weights).sum(axis=2)
    face = cameras.face[camera]
    uv, distance = mirror_map.locate(face, mirror_map.coordinates(face, guess), found.distance, positions[vertex].T)
    place = mirror_map.places(face, uv)
    pixel = view.pixels(place.T)
    near = np.linalg.norm(pixel - view.pixels(guess.T), axis=1) < 8.0 + 0.1 * max(view.resolution)
    near &= mirror_map.meets(face, uv, distance, positions[vertex].T)
    kept = np.flatnonzero(np.isfinite(pixel).all(axis=1) & near)
    return VertexImages(vertex, camera, distance, place, pixel.T).select(kept), counts, found.pair[kept]


def repeated(vertex: np.ndarray, pixel: np.ndarray) -> np.ndarray:
    """Return True (n,) for images that repeat an earlier one: those on an edge or a corner that cameras share.

    An image repeats another one of the same vertex that is less than `SAME_IMAGE` (0.001) pixels away. Each image is
    compared with the eight entries before it only.

    Parameters
    ----------
    vertex : (n,) int64, source vertex of each image, sorted
    pixel : (n, 2) float64, positions of the images in the picture
    """
    again = np.zeros(len(vertex), dtype=bool)
    for gap in range(1, 9):
        same = np.flatnonzero(vertex[gap:] == vertex[:-gap]) + gap
        if not len(same):
            break
        away = np.linalg.norm(pixel[same] - pixel[same - gap], axis=1)
        again[same[away < SAME_IMAGE]] = True
    return again
