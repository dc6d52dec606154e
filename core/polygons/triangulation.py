"""Connection: the reflected polygons as faces on shared nodes."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, following, parent_side, split
from ..support import breathe
from .clipping import Polygons
from .convex_polygons import scene_edges


@dataclass(frozen=True)
class Faces(ColumnArrays):
    """Triangles between nodes.

    Attributes
    ----------
    nodes : (f, 3) int64
    camera : (f,) int64
    column : (f,) int64, of the diffuse triangle in the frames
    on_scene_edge : (f, 3) bool, True for edges 01, 12, 20 that are images of the diffuse triangle's own edges
    """

    counting_axis = 0
    nodes: np.ndarray
    camera: np.ndarray
    column: np.ndarray
    on_scene_edge: np.ndarray

    def split(self, middle: np.ndarray) -> tuple[Faces, np.ndarray]:
        """Split faces at the nodes `middle` (f, 3) of their edges, -1 for none.

        Returns
        -------
        children : Faces
        whole : (m, 3) bool, True for edges of the children that are entire edges of their parents
        """
        parent, local = split(middle >= 0)
        six = np.concatenate((self.nodes, middle), axis=1)[parent]
        side = parent_side(local)
        row = np.arange(len(parent))[:, None]
        on_edge = np.where(side < 3, self.on_scene_edge[parent][row, np.minimum(side, 2)], False)
        whole = (local < 3) & (following(local) < 3) & (side < 3)
        nodes = np.take_along_axis(six, local, axis=1)
        return Faces(nodes, self.camera[parent], self.column[parent], on_edge), whole


def connect(polygons: Polygons, node_of: np.ndarray, pixels: np.ndarray) -> Faces:
    """Triangulate the polygons as fans, each from the corner that gives the least skinny faces.

    Parameters
    ----------
    node_of : (k,) int64, node of each polygon corner
    pixels : (n, 2) float64, picture positions of the nodes
    """
    size, polygon = polygons.size, polygons.polygon
    start, length = polygons.start[:-1][polygon], size[polygon]
    local = np.arange(len(polygon)) - start
    # the corner with the shortest diagonals: sum of squared distances to the corners that are not its neighbours
    spots = pixels[node_of]
    total = np.add.reduceat(spots, polygons.start[:-1], axis=0)[polygon]
    breathe()
    squares = (spots**2).sum(axis=1)
    square_total = np.add.reduceat(squares, polygons.start[:-1])[polygon]
    before, after = start + (local - 1) % length, start + (local + 1) % length
    spread = length * squares - 2.0 * (spots * total).sum(axis=1) + square_total
    breathe()
    spread -= ((spots - spots[before]) ** 2).sum(axis=1) + ((spots - spots[after]) ** 2).sum(axis=1)
    breathe()
    spread = np.where(np.isnan(spread), np.inf, spread)
    bound = np.minimum.reduceat(spread, polygons.start[:-1])[polygon]
    least = np.flatnonzero(spread <= bound)
    apex = local[least[np.flatnonzero(np.diff(polygon[least], prepend=-1))]]

    fan, corner, step = polygons.fans(apex)
    breathe()
    scene = scene_edges(polygons.after)
    first, last = step == 1, step + 2 == size[fan]
    edges = np.stack((scene[corner[0]] & first, scene[corner[1]], scene[corner[2]] & last), axis=1)
    nodes = node_of[corner].T
    faces = Faces(nodes, polygons.camera[fan], polygons.column[fan], edges)
    a, b, c = faces.nodes.T
    return faces.select((a != b) & (b != c) & (c != a))
