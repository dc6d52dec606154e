"""Images of vertices as points on the mirror, without duplicates."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import MirrorMap
from ..geometry import ColumnArrays, mask
from ..polygons import repeated


@dataclass(frozen=True)
class PointImages(ColumnArrays):
    """Images (n) of vertices on the true map.

    Attributes
    ----------
    vertex : (n,) int64, index of the vertex
    face : (n,) int64, mirror triangle of the image
    uv : (2, n) float64, place of the image in that triangle
    distance : (n,) float64, s, distance from the image to the vertex along the ray
    stood : (n,) float64
        Radius of the sphere around the vertices that this one represents, 0 if it represents only itself.
    """

    vertex: np.ndarray
    face: np.ndarray
    uv: np.ndarray
    distance: np.ndarray
    stood: np.ndarray

    @classmethod
    def none(cls) -> PointImages:
        whole, places = np.zeros(0, dtype=np.int64), np.zeros((2, 0))
        return cls(whole, whole, places, places[0], places[0])

    def once(self, mirror_map: MirrorMap) -> PointImages:
        """Return the images sorted by vertex, without duplicates; of duplicates, the one with the largest `stood`."""
        images = self.select(np.lexsort((-self.stood, self.vertex)))
        pixel = mirror_map.view.pixels(mirror_map.places(images.face, images.uv).T)
        return images.select(~repeated(images.vertex, pixel))

    def with_others(self, others: PointImages, mirror_map: MirrorMap, count: int) -> PointImages:
        """Join these images with `others`, without duplicates.

        These images belong to different vertices; `count` is the number of all vertices.
        """
        twice = mask(count, others.vertex)[self.vertex]
        return PointImages.joined((self.select(~twice),
                                   PointImages.joined((self.select(twice), others)).once(mirror_map)))
