"""Contacts: where the scene stands on the mirror or cuts through it, closely hidden parts of cameras are cut off.

The distance between such a part of a camera and its occluder goes to zero along the line of contact. The reflection
there would come out in front of the occluder when it slides towards the eye.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import chain

import numpy as np

from ..cameras import Cameras, picture_areas
from ..culling import Candidates, Opacities, inherited
from ..geometry import TriangleMesh, distinct, largest, mask, meeting, norm, numbered, rows, smallest
from ..result import DEPTH, GAP
from ..support import crowded, portions
from .hidden_parts import DEEPER, MOST_HIDING, HiddenParts
from .picture_pairs import PAIRS_AT_ONCE, pairs_in_picture

AGAIN = 4  # pairs that are looked at again after cutting, to one that may be left
CELLS = 256.0  # grid cells across the wider side of the picture, to find overlaps


def drop_behind_contacts(candidates: Candidates, maximum: int,
                         again: Callable[[Cameras, tuple[np.ndarray, np.ndarray]], Candidates],
                         opacities: Opacities = Opacities(),
                         slide: float = 1.0) -> tuple[Candidates, np.ndarray, int, int]:
    """Cut off the parts of cameras that triangles hide closer than layers slide, up to about `maximum` pieces.

    Parameters
    ----------
    again : callable, finds the candidates among pairs of a camera and a column, for the pieces of cut cameras
    opacities : Opacities, of the triangles; triangles that may be covered cut nothing off
    slide : float, share of the usual distance that layers slide

    Returns
    -------
    candidates : Candidates
    crowd : (n,) bool, True for cameras with too many candidates to search again
    count : int, number of cameras that were cut
    left : int, number of cameras that were not cut, or not along all outlines
    """
    cameras, frames = candidates.cameras, candidates.frames
    found, left = _hidden_closely(candidates, opacities, slide * (GAP + DEPTH))
    if found is None:
        return candidates, np.zeros(len(cameras), dtype=bool), 0, left
    hidden, shown = found
    count = np.bincount(hidden.camera, minlength=len(cameras))
    uncut = crowded(count, picture_areas(cameras), MOST_HIDING)
    hidden = hidden.select(~uncut[hidden.camera])
    given, (cameras, cut, parent, entire) = len(cameras), hidden.cut_off(cameras, shown, hidden.outlines(
        cameras.view, frames), maximum)
    left += entire + int(uncut.sum())
    if shown.all() and not len(cut):
        return candidates, np.zeros(given, dtype=bool), 0, left
    whole = shown.copy()
    whole[cut] = False
    now, before = numbered(given, whole), int(whole.sum())
    # find the other candidates of a cut camera again, for each of its pieces
    asked = np.flatnonzero(mask(given, cut)[candidates.camera])
    camera, column = candidates.camera[asked], candidates.column[asked]
    crowd, piece = np.zeros(len(cameras), dtype=bool), before + np.arange(len(parent))
    crowd[piece] = crowded(np.bincount(camera, minlength=given)[parent], picture_areas(cameras.select(piece)),
                           AGAIN * maximum)
    sparse = ~crowd[piece]
    of_pieces = again(cameras, inherited(camera, column, parent[sparse], piece[sparse]))
    return (Candidates.joined((candidates.on(cameras, now), of_pieces)), crowd,
            len(cut) + int((~shown).sum()), left)


def _hidden_closely(candidates: Candidates, opacities: Opacities,
                    slid: float) -> tuple[tuple[HiddenParts, np.ndarray] | None, int]:
    """Find parts of cameras that triangles hide so closely that layers would come out in front of the triangles.

    Layers slide towards the eye by the share `slid` of the distance.

    Returns
    -------
    found : tuple or None
        The hidden parts, and True (n,) for cameras that no triangle hides entirely; None if no triangle is so near.
    left : int, number of cameras that were tested against nearby triangles behind the eye only
    """
    cameras, frames, view = candidates.cameras, candidates.frames, candidates.cameras.view
    size = float(np.ptp(cameras.places, axis=1).max(initial=0.0))
    room = slid * (np.full(len(cameras), size) if view.orthographic else
                   norm(cameras.places - view.eye[:, None])[cameras.corners].max(axis=1))
    near = _near(candidates, room)
    near = near.select(opacities.not_to_cover(frames.triangle[near.column]))
    column, row_of = distinct(near.column)
    if not len(column):
        return None, 0
    shown, found = np.ones(len(cameras), dtype=bool), []
    pairs, left = _lying_over(near, column, row_of)
    for camera, row in pairs:
        hidden = HiddenParts.of(cameras, frames, camera, column[row], DEEPER * size)
        hidden = hidden.select(hidden.nearest(view.orthographic) < slid * (size if view.orthographic else 1.0))
        shown[hidden.camera[hidden.entire]] = False
        found.append(hidden)
    if not found:
        return None, left
    hidden = HiddenParts.joined(found)
    return (hidden.select(shown[hidden.camera]), shown), left


def _lying_over(near: Candidates, column: np.ndarray,
                row_of: np.ndarray) -> tuple[Iterable[tuple[np.ndarray, np.ndarray]], int]:
    """Find pairs of a camera and a triangle that may overlap in the picture.

    Pairs that reach behind the eye are taken from the candidates `near` (p) instead.

    Parameters
    ----------
    column : (k,) int64, the triangles, as columns of the frames
    row_of : (p,) int64, index in `column` of the triangle of each candidate

    Returns
    -------
    pairs : iterable of cameras and indices in `column`
    left : int, number of cameras for which only pairs that reach behind the eye are given, as there are too many others
    """
    cameras, frames, view = near.cameras, near.frames, near.cameras.view
    mesh = TriangleMesh(frames.positions[frames.vertices[:, column]].reshape(-1, 3),
                        np.arange(3 * len(column)).reshape(3, -1).T)
    scale = CELLS / max(view.resolution)
    everywhere = np.ones(tuple(int(side) for side in np.ceil(np.array(view.resolution[::-1]) * scale)), dtype=bool)
    pictured = pairs_in_picture(cameras, mesh, np.full(len(column), -1), everywhere, scale)
    behind, others = ((view.depths(places.T) <= 0.0)[corners].any(axis=1) for places, corners in (
        (cameras.places, cameras.corners), (mesh.positions.T, mesh.triangles)))
    pairs = np.unique((near.camera * len(column) + row_of)[behind[near.camera] | others[row_of]])
    reaching = [np.divmod(pairs, len(column))] if len(pairs) else []
    return (reaching, len(np.unique(near.camera))) if pictured is None else (chain(pictured, reaching), 0)


def _near(candidates: Candidates, room: np.ndarray) -> Candidates:
    """Return the candidates whose triangle comes as near as `room` (n,), in scene units, to its camera."""
    cameras, frames = candidates.cameras, candidates.frames
    some = room[candidates.camera] * norm(frames.normal)[candidates.column]
    near = np.flatnonzero((smallest(candidates.ahead) < some) & (largest(candidates.ahead) > -some))
    found = [near[:0]]
    for part in portions(len(near), PAIRS_AT_ONCE):
        camera, column = candidates.camera[near[part]], candidates.column[near[part]]
        corners = np.take(cameras.places, cameras.corners[camera].T, axis=1)
        found.append(near[part][meeting(corners, rows(frames.positions[frames.vertices[:, column]]), room[camera])])
    return candidates.select(np.concatenate(found))
