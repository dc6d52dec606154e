"""Images of vertices as points: where on the mirror each is truly seen, each once."""
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
    vertex : (n,) int64
    face : (n,) int64, the mirror's triangle
    uv : (2, n) float64
    distance : (n,) float64, s
    stood : (n,) float64
        Radius of the sphere round the vertices that this one stands for, 0 where it stands for itself alone.
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
        """The images by their vertices; of several that are one, that which stands for most."""
        images = self.select(np.lexsort((-self.stood, self.vertex)))
        pixel = mirror_map.view.pixels(mirror_map.places(images.face, images.uv).T)
        return images.select(~repeated(images.vertex, pixel))

    def with_others(self, others: PointImages, mirror_map: MirrorMap, count: int) -> PointImages:
        """These images, each of another one of `count` vertices, and the others that are none of them."""
        twice = mask(count, others.vertex)[self.vertex]
        return PointImages.joined((self.select(~twice),
                                   PointImages.joined((self.select(twice), others)).once(mirror_map)))
