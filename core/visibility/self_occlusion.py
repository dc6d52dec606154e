"""Self-occlusion: the parts of cameras that nearer parts of the mirror hide are cut off exactly.

Hidden parts would cost work and, where the hiding part lies closer before them than reflections slide towards the eye,
come out in front of it.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, picture_areas
from ..geometry import SceneFrames, TriangleMesh, cross, norm
from ..support import crowded
from ..views import LampView
from .eye_plane import triangles_before_eye
from .hidden_parts import DEEPER, MOST_HIDING, HiddenParts
from .mirror_visibility import DepthGrid
from .picture_pairs import pairs_in_picture

MOST_PIECES = 1 << 18  # pieces of all cut cameras together
EDGE = 1e-3  # factor on `DEEPER` in lamps' views, where an occluder meets the mirror at an angle
LEVEL = 0.01  # sine of the angle between planes below which faces may be doubled
MOST_WORK = 1 << 23  # lines of cameras, each once for every triangle that hides a part of its camera


def without_occluded(mirror: TriangleMesh, cameras: Cameras, grid: DepthGrid) -> tuple[Cameras, int, int]:
    """Cut off the parts of three-ray cameras that other triangles of the mirror hide from the eye.

    There is a camera for each triangle of the mirror.

    Returns
    -------
    cameras : Cameras
    cut : int, number of cameras that were cut
    left : int, number of cameras with too many occluders: some of these hide a part that was not cut off
    """
    view = cameras.view
    mirror, owner = triangles_before_eye(view, mirror, np.unique(cameras.face))
    frames = SceneFrames.of(mirror, np.arange(len(owner)))
    shown, deeper = np.ones(len(cameras), dtype=bool), DEEPER * np.ptp(cameras.places, axis=1).max()
    parts = []
    pairs = pairs_in_picture(cameras, mirror, owner, grid.layers > 1, grid.scale)
    if pairs is None:
        return cameras, 0, len(cameras)
    for camera, column in pairs:
        hidden = HiddenParts.of(cameras, frames, camera, column, deeper * _rounding(cameras, frames, camera, column))
        shown[hidden.camera[hidden.entire]] = False
        parts.append(hidden.select(shown[hidden.camera]))
    if not parts:
        return cameras, 0, 0
    count, worth = np.zeros(len(cameras), dtype=np.int64), picture_areas(cameras)
    for hidden in parts:
        count += np.bincount(hidden.camera, minlength=len(cameras))
    uncut = crowded(np.where(shown, count, 0), worth, MOST_HIDING)
    kept = shown & ~uncut
    hidden = HiddenParts.joined([one.select(kept[one.camera]) for one in parts])
    lines = hidden.outlines(view, frames)
    # estimate the work: each piece between the lines is tested against each triangle that hides a part of its camera
    load = np.bincount(lines.camera, minlength=len(cameras)) * count
    uncut |= crowded(load, worth, MOST_WORK)
    hidden, lines = hidden.select(~uncut[hidden.camera]), lines.select(~uncut[lines.camera])
    cut, _, _, left = hidden.cut_off(cameras, shown, lines, MOST_PIECES)
    return cut, int((count > 0).sum() - uncut.sum()), int(uncut.sum()) + left


def _rounding(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> np.ndarray | float:
    """Return the factor (p,) on `DEEPER` for pairs of a `camera` (p,) and a triangle `column` (p,).

    It is `EDGE` for a lamp and a triangle at an angle to the mirror: the lamp may be so near to an object that touches
    the mirror that much of its light would leak through the gap.
    """
    if not isinstance(cameras.view, LampView):
        return 1.0
    surface, face = cameras.mirror_map.last(cameras.face[camera])
    own, other = surface.face_normal[:, face], frames.normal[:, column]
    return np.where(norm(cross(own, other)) <= LEVEL * norm(other), 1.0, EDGE)
