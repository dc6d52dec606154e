"""Seams: where whole faces lie beside faces that cameras have cut, both get the same nodes.

What a camera shows of a triangle has a node wherever the image of an edge crosses a side of the mirror. A whole face on
the other side of that edge would leave a crack of as much as its chord strays: it takes all these nodes into its edge.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..cameras import Cameras
from ..geometry import SceneFrames, between, edge_numbers, following, groups, next_corner, others, ranges
from ..polygons import Faces, Nodes
from .images import Images
from .whole import WholeFaces

ON_EDGE = 1e-6  # share of a triangle's size: a node as near to an edge lies on it, one as near to an end is the end
SAME_IMAGE = 0.05  # pixels: ends that are farther apart are two images


@dataclass(frozen=True)
class Seamed:
    """Unclipped faces (f) that share nodes with the adjacent faces of cameras.

    Attributes
    ----------
    place, point : (3, n) float64, of the faces' own nodes, in world space
    same : (n,) int64, node of the cameras' faces that each own node coincides with, or -1
    nodes : (f, 3) int64, own nodes, or n plus a node of the cameras' faces
    source : (f,) int64, the scene's triangle that each face lies in
    split : (f,) bool, True if the face is only a part of that triangle
    mirror_face : (f,) int64, the mirror's triangle that each face lies on, -1 if there are several
    """

    place: np.ndarray
    point: np.ndarray
    same: np.ndarray
    nodes: np.ndarray
    source: np.ndarray
    split: np.ndarray
    mirror_face: np.ndarray


def seamed(whole: WholeFaces, cameras: Cameras, frames: SceneFrames, nodes: Nodes,
           faces: Faces) -> tuple[Seamed, Nodes]:
    """Connect the drawn unclipped faces to the `faces` of cameras along shared scene edges, without cracks.

    Returns
    -------
    seamed : Seamed, the unclipped faces, with the cameras' nodes on their edges
    nodes : Nodes, of the cameras' faces, moved to the unclipped faces' nodes where both have the same end
    """
    images, drawn, left = whole.images, whole.pieces.select(whole.drawn), whole.pieces.select(whole.left)
    count = len(images)
    own = _edges(drawn.nodes.T, count)
    seam = np.intersect1d(own, _edges(left.nodes.T, count))
    on_patch = faces.select(np.isin(cameras.face[faces.camera], whole.patch.face))
    key, node, share = _on_edges(frames, nodes, on_patch, seam, count)
    same = np.full(count, -1)
    view, eye = whole.patch.view, whole.patch.eye
    for end, near in ((key // count, share < ON_EDGE), (key % count, share > 1.0 - ON_EDGE)):
        image, own_node = end[near], node[near]
        away = np.linalg.norm(view.pixels(nodes.place[:, own_node].T).T - images.pixel[:, image], axis=0)
        same[image[away < SAME_IMAGE]] = own_node[away < SAME_IMAGE]
    met = np.flatnonzero(same >= 0)
    place, point, distance = nodes.place.copy(), nodes.point.copy(), nodes.distance.copy()
    place[:, same[met]], point[:, same[met]] = images.place[:, met] + eye, images.point[:, met] + eye
    distance[same[met]] = images.distance[met]
    inside = (share >= ON_EDGE) & (share <= 1.0 - ON_EDGE)
    order = np.lexsort((share[inside], key[inside]))
    key, node = key[inside][order], node[inside][order]
    split = np.bincount(whole.pieces.source)[drawn.source] > 1
    images, corners, face = _with_nodes(whole, images, drawn.nodes.T, own, key, node)
    member = images.member[np.minimum(corners, len(images) - 1)]
    alone = (member == member[:, :1]).all(axis=1) & (corners < len(images)).all(axis=1)
    same = np.concatenate((same, np.full(len(images) - count, -1)))
    return Seamed(images.place + eye, images.point + eye, same, corners, drawn.source[face],
                  split[face] | (np.bincount(face)[face] > 1),
                  np.where(alone, whole.patch.face[member[:, 0]], -1)), Nodes(place, point, distance)


def _edges(nodes: np.ndarray, count: int) -> np.ndarray:
    """Number the edges 01, 12, 20 of faces with corners `nodes` (f, 3): (f, 3), the same number from both sides."""
    return edge_numbers(nodes, following(nodes), count)


def _on_edges(frames: SceneFrames, nodes: Nodes, faces: Faces, seam: np.ndarray,
              count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the nodes of the cameras' `faces` on edges of the `seam`, numbers of scene edges, sorted.

    Returns
    -------
    key : (k,) int64, number of the edge
    node : (k,) int64, into `nodes`
    share : (k,) float64, position along the edge, from 0 at its lower end to 1
    """
    face, side = np.nonzero(faces.on_scene_edge)
    ends = np.stack((faces.nodes[face, side], faces.nodes[face, next_corner(side)]))
    column, row = faces.column[face], np.arange(len(face))
    weights = [frames.weights(column, nodes.point[:, end]) for end in ends]
    off = np.maximum(*np.abs(weights))
    third = off.argmin(axis=0)
    vertices = frames.vertices[:, column]
    first, second = others(third)
    one, other = vertices[first, row], vertices[second, row]
    whole_edge = (np.maximum(one, other) < count) & (off[third, row] < ON_EDGE)
    key = np.where(whole_edge, edge_numbers(one, other, count), -1)
    at = np.minimum(np.searchsorted(seam, key), max(len(seam) - 1, 0))
    kept = np.flatnonzero(seam[at] == key) if len(seam) else np.zeros(0, dtype=np.int64)
    toward = np.where(one > other, first, second)
    found = [(key[kept], end[kept], weight[toward[kept], kept]) for end, weight in zip(ends, weights)]
    key, node, share = (np.concatenate(part) for part in zip(*found))
    once, _ = groups(key, node)
    return key[once], node[once], share[once]


def _with_nodes(whole: WholeFaces, images: Images, nodes: np.ndarray, own: np.ndarray, key: np.ndarray,
                node: np.ndarray) -> tuple[Images, np.ndarray, np.ndarray]:
    """Insert nodes into the edges of faces with corners `nodes` (f, 3): these faces become fans around their centres.

    Parameters
    ----------
    own : (f, 3) int64, numbers of the faces' edges
    key, node : (k,) int64, edge and node to insert, sorted by edge and along each edge from its lower end

    Returns
    -------
    images : Images, the given ones, then those of the centres
    corners : (g, 3) int64, of all faces
    face : (g,) int64, the given face that each is a part of
    """
    count = len(images)
    start, more = between(key, own, own)
    chosen = np.flatnonzero(more.any(axis=1))
    rest = np.flatnonzero(~more.any(axis=1))
    if not len(chosen):
        return images, nodes[rest], rest
    middles = _middles(whole, images, nodes[chosen])
    # the corners of each ring: along each edge its first end, and the nodes on it
    start, more, corners = start[chosen].ravel(), more[chosen].ravel(), nodes[chosen]
    back = (corners > following(corners)).ravel()
    step, edge = ranges(np.zeros(len(more), dtype=np.int64), more + 1)
    at = np.where(back[edge], start[edge] + more[edge] - step, start[edge] + step - 1)
    ring = np.where(step == 0, corners.ravel()[edge], count + len(middles) + node[np.minimum(at, len(node) - 1)])
    fan = edge // 3
    after = np.append(ring[1:], ring[:1])
    first = np.append(0, np.flatnonzero(np.diff(fan)) + 1)
    after[np.append(first[1:], len(fan)) - 1] = ring[first]
    return Images.joined((images, middles)), np.concatenate((
        nodes[rest], np.stack((ring, after, count + fan), axis=1))), np.concatenate((rest, chosen[fan]))


def _middles(whole: WholeFaces, images: Images, nodes: np.ndarray) -> Images:
    """Find the images of the centres of faces with corners `nodes` (f, 3); interpolate images that are not found."""
    found = images.around(whole.patch, nodes.T)
    return replace(found, place=np.where(found.found, found.place, images.place[:, nodes].mean(axis=2)),
                   distance=np.where(found.found, found.distance, images.distance[nodes].mean(axis=1)))
