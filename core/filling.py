"""Filling: what is still open after clipping is found, and filled from rays traced backwards.

Where rays cross, on a caustic or on a triangle seen exactly edge on, outlines stay bent however small a camera gets.
Refinement stops at cameras of a pixel: one ray through the middle of each says which triangle is seen, and the whole
camera shows that triangle, on corners that it shares with its neighbours (`fill`).

All other polygons must meet without holes. Where they do not, rays say which triangle is missing in which camera
(`openings`). If it was never cut to that camera, it is now, and its corners are the same nodes as its neighbours'.
What is open even then is filled by cells of a pixel (`ray_cells`).
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from .cameras import Cameras
from .candidates import Candidates, overlapping
from .clipping import FILLED, Polygons, clip
from .cones import Cones
from .coverage import touching
from .images import VertexImages
from .nodes import Nodes, polygon_nodes
from .openings import Openings, find_openings
from .ray_cells import Cells, ray_cells
from .reflection_map import ReflectionMap
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .stepping import breathe
from .unmatched_edges import following_corners
from .vectors import groups, norm, rows
from .view import View

ROUNDS = 3  # of finding and clipping, then of finding and cells: an opening may show the next one


def fill(mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames, candidates: Candidates, polygons: Polygons,
         open_: np.ndarray) -> tuple[Polygons, int]:
    """Polygons in which each open camera shows the one triangle that the ray through its middle meets first.

    Parameters
    ----------
    open_ : (n,) bool
        Cameras to fill.

    Returns
    -------
    polygons : Polygons
    rays : int
        How many rays were traced.
    """
    pairs = np.flatnonzero(open_[candidates.camera])
    if not len(pairs):
        return polygons, 0
    camera, column = candidates.camera[pairs], candidates.column[pairs]
    face = cameras.face[camera]
    middle = np.take(cameras.places, cameras.corners[camera].T, axis=1).mean(axis=1)
    origin, ray = mirror_map.leave(face, mirror_map.coordinates(face, middle))
    distance = frames.distance(column, origin, ray)
    hit = (frames.weights(column, origin + distance * ray) >= 0.0).all(axis=0) & (distance > 0.0)
    order = np.lexsort((distance[hit], camera[hit]))
    _, first = np.unique(camera[hit][order], return_index=True)
    shown = pairs[hit][order[first]]

    kept = polygons.select(~open_[candidates.camera[polygons.pair]])
    whole = np.tile(np.array([2, 0, 1], dtype=np.int8), len(shown))
    filled = Polygons(shown, 3 * np.arange(len(shown) + 1), np.tile(np.eye(3), (1, len(shown))),
                      np.tile(np.array([1, 2, 0], dtype=np.int8), len(shown)), whole)
    return Polygons.joined((kept, filled)), len(np.unique(camera))


def fill_openings(view: View, mirror_map: ReflectionMap, cameras: Cameras, tree: SceneTree, frames: SceneFrames,
                  images: VertexImages, candidates: Candidates, polygons: Polygons, nodes: Nodes,
                  node_of: np.ndarray) -> tuple[Candidates, Polygons, Nodes, np.ndarray, dict]:
    """Polygons without openings, after the first bounce.

    Parameters
    ----------
    node_of : (k,) int64
        Node of each polygon corner.

    Returns
    -------
    candidates : Candidates
        With the pairs that rays found.
    polygons : Polygons
        With what was missing; cells carry the label FILLED all round.
    nodes : Nodes
    node_of : (k,) int64
        Node of each polygon corner.
    counts : dict
        `unmatched`, edges without a partner; `openings`, places beside them at which rays found something missing,
        and `open`, how many are left, narrower than a cell; `filled`, polygons and cells added; `filled_pixels`, their
        area; `rays` traced; `unfilled`, 1 where a bound stopped the cells.
    """
    def find() -> Openings:
        found = find_openings(view, mirror_map, cameras, tree, frames, candidates, polygons, node_of, pixels, watched)
        counts["rays"] += found.rays
        return found

    counts = {"rays": 0, "unfilled": 0}
    watched, celled = np.ones(len(cameras), dtype=bool), np.zeros(len(cameras), dtype=bool)
    pixels, before = view.pixels(nodes.place.T), len(polygons.pair)
    openings = find()
    counts["unmatched"], counts["openings"] = openings.edges, len(openings)
    watched = touching(cameras, openings.camera)
    for _ in range(ROUNDS):
        if not len(openings):
            break
        breathe()
        missing, pieces = _missing(cameras, tree, frames, candidates, polygons, openings)
        if not len(pieces.pair):
            break
        candidates, polygons = _joined(candidates, polygons, missing, pieces)
        nodes, node_of = _piece_nodes(view, mirror_map, cameras, frames, tree.mesh.positions, candidates, polygons,
                                      images, nodes, node_of)
        pixels = view.pixels(nodes.place.T)
        openings = find()
        watched |= touching(cameras, openings.camera)
    left = openings
    for _ in range(ROUNDS):
        if not len(left):
            break
        celled[left.camera] = True
        cells = ray_cells(view, mirror_map, cameras, tree, frames, candidates, polygons, pixels[node_of], left)
        counts["rays"] += cells.rays
        counts["unfilled"] |= int(cells.large)
        nodes, shown = _cell_nodes(view, frames, tree.mesh.positions, nodes, cells)
        candidates, polygons = _joined(candidates, polygons, *_as_polygons(cells))
        node_of, pixels = np.concatenate((node_of, shown)), view.pixels(nodes.place.T)
        openings = find()
        watched |= touching(cameras, openings.camera)
        left = openings.select(~celled[openings.camera]).joined(cells.rim)
    counts["unfilled"] |= int(len(left) > 0)
    counts["open"], counts["filled"] = len(openings), len(polygons.pair) - before
    counts["filled_pixels"] = int(np.ceil(_area(polygons, pixels[node_of], before)))
    return candidates, polygons, nodes, node_of, counts


def _missing(cameras: Cameras, tree: SceneTree, frames: SceneFrames, candidates: Candidates, polygons: Polygons,
             openings: Openings) -> tuple[Candidates, Polygons]:
    """What the open cameras see by their cones and have no polygon of, cut to them."""
    columns = len(frames.triangle)
    open_ = np.unique(openings.camera)
    cone, triangle, _ = tree.trace(Cones.around(cameras.select(open_)))
    column, known = frames.columns(triangle)
    found = np.unique(np.concatenate((open_[cone[known]] * columns + column[known],
                                      openings.camera * columns + openings.column)))
    present = candidates.camera[polygons.pair] * columns + candidates.column[polygons.pair]
    found = found[~np.isin(found, present)]
    missing = overlapping(cameras, frames, found // columns, found % columns)
    return missing, clip(missing)


def _piece_nodes(view, mirror_map, cameras, frames, positions, candidates, polygons, images, nodes,
                 node_of) -> tuple[Nodes, np.ndarray]:
    """The nodes with those of the last polygons, which have none yet: the ones of polygons that touch them, and new."""
    size, camera = np.diff(polygons.start), candidates.camera[polygons.pair]
    piece = polygons.start[1:] > len(node_of)
    near = touching(cameras, camera[piece])[camera]
    found, found_of = polygon_nodes(view, mirror_map, cameras, frames, positions, candidates, polygons.select(near),
                                    images)
    of_piece = np.repeat(piece[near], size[near])
    name = np.full(len(found.distance), -1)
    name[found_of[~of_piece]] = node_of[np.repeat(near[~piece], size[~piece])]
    new = name < 0
    name[new] = len(nodes.distance) + np.arange(new.sum())
    nodes = nodes.joined(found.place[:, new], found.point[:, new], found.distance[new])
    return nodes, np.concatenate((node_of, name[found_of[of_piece]]))


def _joined(candidates: Candidates, polygons: Polygons, more: Candidates,
            pieces: Polygons) -> tuple[Candidates, Polygons]:
    """Both lists with `pieces` of the pairs `more` behind."""
    pieces = replace(pieces, pair=pieces.pair + len(candidates))
    return Candidates.joined((candidates, more)), Polygons.joined((polygons, pieces))


def _cell_nodes(view: View, frames: SceneFrames, positions: np.ndarray, nodes: Nodes,
                cells: Cells) -> tuple[Nodes, np.ndarray]:
    """The nodes with those of the cells, one for each corner and triangle, and the node of each cell's corner."""
    first, shown = groups(cells.cells.corners.ravel(), np.repeat(cells.column, 3))
    corner, column = cells.cells.corners.ravel()[first], cells.column[first // 3]
    place, ray = cells.cells.places[:, corner], cells.cells.rays[:, corner]
    # beyond the triangle's rim, which ends somewhere in the cell, the rim stands in
    point = place + np.maximum(frames.distance(column, place, ray), 0.0) * ray
    weights = np.maximum(frames.weights(column, point), 0.0)
    point = (rows(positions[frames.vertices[:, column]]) * (weights / weights.sum(axis=0))).sum(axis=1)
    distance = norm(point - place) / norm(view.directions(place.T).T)
    return nodes.joined(place, point, distance), shown + len(nodes.distance)


def _as_polygons(cells: Cells) -> tuple[Candidates, Polygons]:
    """Cells as polygons of pairs that clipping says nothing about."""
    count = len(cells.camera)
    label = np.full(3 * count, FILLED, dtype=np.int8)
    pairs = Candidates.unknown(cells.camera, cells.column)
    return pairs, Polygons(np.arange(count), 3 * np.arange(count + 1), np.tile(np.eye(3), (1, count)), label, label)


def _area(polygons: Polygons, corners: np.ndarray, first: int) -> float:
    """Pixels that the polygons from the `first` on cover, where corners (k, 2) are the picture's."""
    following = corners[following_corners(polygons)]
    parts = 0.5 * (corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0])
    if first == len(polygons.pair):
        return 0.0
    return float(np.abs(np.add.reduceat(parts, polygons.start[:-1])[first:]).sum())
