"""The truth by Cycles, at the pixels' centres and at places anywhere in the pixels.

Places within the pixels are the centres of the pixels of a coarser picture, whose sides have no divisor in common with
those of the picture that is judged, from a camera shifted by a random part of a pixel: so they lie everywhere in the
pixels alike, and independent of where any method takes its samples.
"""
from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import bpy
import numpy as np

from ...core import View
from ...core.rivals import eye_depths
from .. import compat
from ..faults import finished
from ..judge import CodedMaterials, CodedTruth, CopiedScene, cycles_render, lowest_corner
from ..metrics import ITSELF, NOTHING, CodedPicture, motion_per_pixel
from .case import Case

SEED = 20060301
RENDERS = 2
COARSER = 2.0 ** 0.5    # times as far apart as pixels are the places in one render, so that two have as many


@dataclass(frozen=True)
class Truth:
    """The ground truth at the centres of a picture's n pixels, in rows from bottom to top.

    Attributes
    ----------
    columns, rows : (width,), (height,) float64
        Positions of the centres in the compared picture, in its pixels.
    view : View
        View whose pixel centres these are: the same eye, another grid of pixels.
    mirror, judged, empty : (n,) bool
        True where a mirror is visible; the same without bent normals and mirrors in mirrors; those of them that reflect
        no diffuse object.
    pixel : (k,) int64
        Indices of the judged pixels that show a diffuse object.
    source, face : (k,) int64
        Diffuse object and polygon there.
    position : (k, 3) float64
    motion : (k,) float64
        Scene units from one pixel of the compared picture to the next, NaN if unknown.
    mirror_depth, scene_depth : (height, width) float64
        See `PrimaryHits`.
    """

    columns: np.ndarray
    rows: np.ndarray
    view: View
    mirror: np.ndarray
    judged: np.ndarray
    empty: np.ndarray
    pixel: np.ndarray
    source: np.ndarray
    face: np.ndarray
    position: np.ndarray
    motion: np.ndarray
    mirror_depth: np.ndarray
    scene_depth: np.ndarray


@dataclass(frozen=True)
class Truths:
    """All that judges the methods on one scene.

    Attributes
    ----------
    centres : Truth
        At the pixels' centres.
    area : list of Truth
        At places anywhere in the pixels.
    pictures : (mirror, bent, CodedPicture)
        The first as pictures, as `measure` takes them.
    """

    centres: Truth
    area: list
    pictures: tuple


def render_truths(context: bpy.types.Context, copied: CopiedScene, case: Case) -> Truths:
    """Render the truth of a case in a copy of its scene.

    From Blender 5.0 on Cycles rounds normals; it is handed unrounded ones here.
    """
    scene, camera = copied.scene, copied.scene.camera.data
    cycles_render.prepare(scene, depth=1)
    own = [(slot, slot.material) for copy in copied.everything for slot in copy.material_slots]
    coded = CodedTruth(copied, CodedMaterials(copied, lowest_corner(copied)), depth=1)
    start, random = np.array((camera.shift_x, camera.shift_y)), np.random.default_rng(SEED)
    size, coarse = case.view.resolution, coarser(case.view.resolution)
    truths, pictures = [], None
    for lattice, shift in [(size, np.zeros(2))] + [(coarse, random.uniform(-0.5, 0.5, 2)) for _ in range(RENDERS)]:
        scene.render.resolution_x, scene.render.resolution_y = lattice
        scene.render.resolution_percentage = 100
        # in units of the longer side, or as the sensor's fit has it: within a pixel or so, which is all that matters
        camera.shift_x, camera.shift_y = start + shift / max(lattice)
        view = case.view if not truths else _view(context, scene, case, lattice)
        seen, bent = finished(coded.mirror())
        truth = finished(coded.reflected(seen, unrounded=bool(compat.packs_normals())))
        pictures = pictures or (seen, bent, truth)
        truths.append(_truth(case, view, seen, bent, truth))
    camera.shift_x, camera.shift_y = start
    scene.render.resolution_x, scene.render.resolution_y = size
    coded.end()
    for slot, material in own:
        slot.material = material
    return Truths(truths[0], truths[1:], pictures)


def coarser(size: tuple[int, int]) -> tuple[int, int]:
    """Return a picture's size divided by about `COARSER`.

    The width and the old width have no common divisor, nor have the heights, so that few pixel centres coincide.
    """
    def side(length: int) -> int:
        found = max(2, round(length / COARSER))
        while gcd(found, length) > 1:
            found += 1
        return found
    return side(size[0]), side(size[1])


def lattice_in(view: View, other: View) -> tuple[np.ndarray, np.ndarray]:
    """Return the positions of the pixel columns (w,) and rows (h,) of `other` in pixels of `view`. Both views have the
    same eye.
    """
    found = []
    last = 3 if view.orthographic else 2
    sign = 1.0 if view.orthographic else -1.0
    for axis, count in enumerate(other.resolution):
        place = (np.arange(count) + 0.5) / count * 2.0 - 1.0
        eye = (place - sign * other.projection[axis, last]) / other.projection[axis, axis]
        place = view.projection[axis, axis] * eye + sign * view.projection[axis, last]
        found.append((0.5 * place + 0.5) * view.resolution[axis])
    return found[0], found[1]


def _view(context: bpy.types.Context, scene: bpy.types.Scene, case: Case, lattice: tuple[int, int]) -> View:
    """Return the view of the copied camera."""
    render = scene.render
    projection = scene.camera.calc_matrix_camera(context.evaluated_depsgraph_get(), x=lattice[0], y=lattice[1],
                                                 scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    return View(case.view.camera_to_world, np.array(projection, dtype=np.float64), lattice)


def _truth(case: Case, view: View, seen: np.ndarray, bent: np.ndarray, truth: CodedPicture) -> Truth:
    judged = seen & ~bent & (truth.source != ITSELF)
    pixel = np.flatnonzero(judged & (truth.source >= 0))
    columns, rows = lattice_in(case.view, view)
    step = 0.5 * (np.diff(columns).mean() + np.diff(rows).mean())
    return Truth(columns, rows, view, seen.ravel(), judged.ravel(), (judged & (truth.source == NOTHING)).ravel(), pixel,
                 truth.source.ravel()[pixel], truth.face.ravel()[pixel], truth.position.reshape(-1, 3)[pixel],
                 motion_per_pixel(truth).ravel()[pixel] / step, *eye_depths(view, case.mirror, case.scene.mesh))
