"""The lamps that a mirror may show as bodies, and those of them that a result has before what it shows."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError
from ..illumination import eyes_of, is_glint, is_met, is_shown_in, rays_meet
from ..reading import seen_in, vectors

KNOWN = ("mirror_position", "reflected_position", "bounces")  # what a result must tell
CHUNK = 1 << 14  # faces at once


@dataclass(frozen=True)
class ShownLamp:
    """A lamp as a body that shines.

    Attributes
    ----------
    place : (3,) float64
        Its middle, in world space.
    axes : (3, 3) float64
        World axes x, y, z; it shines along -z. Unit columns, but for spots as `illumination.Eye` has it.
    shape : {'RECTANGLE', 'ELLIPSE', 'BALL', 'DISC'}
        The first two lie across z; a disc faces what sees it.
    size : tuple of float
        Along x and y, or twice the radius.
    radiance : tuple of float
        Red, green and blue, in W/m2/sr, along -z.
    cone : tuple of float
        As `illumination.Eye` has it.
    spot : bool
        Whether it shines within a cone alone.
    lamp : bpy.types.Object or None
        None is shown by every mirror.
    """

    place: np.ndarray
    axes: np.ndarray
    shape: str
    size: tuple[float, float]
    radiance: tuple[float, float, float]
    cone: tuple[float, float]
    spot: bool
    lamp: bpy.types.Object | None = None

    @property
    def reach(self) -> float:
        """No part of it is farther from its middle."""
        if self.spot:
            return 0.5 * float(np.hypot(*self.size))
        right, up = np.linalg.inv(self.axes)[:2] * np.array(self.size)[:, None]
        return 0.5 * float(max(np.linalg.norm(right + up), np.linalg.norm(right - up)))


def lamps_that_show(context: bpy.types.Context) -> list[ShownLamp]:
    """The scene's lamps that mirrors show before what they reflect: suns lie behind all of it."""
    lamps = [obj for obj in context.view_layer.objects if obj.type == "LIGHT" and obj.data.type != "SUN"
             and is_met(obj) and not is_glint(obj)]
    if not lamps:
        return []
    depsgraph, shown = context.evaluated_depsgraph_get(), []
    for obj in filter(seen_in(context), lamps):
        try:
            shown.append(_shown(depsgraph, obj))
        except ReflectionError:
            # it gives no light
            continue
    return shown


def _shown(depsgraph: bpy.types.Depsgraph, lamp: bpy.types.Object) -> ShownLamp:
    data = lamp.evaluated_get(depsgraph).data
    eye, = eyes_of(depsgraph, lamp, 1, np.zeros(3))
    matrix = np.array(lamp.evaluated_get(depsgraph).matrix_world, dtype=np.float64)
    if data.type == "AREA":
        round_, oblong = data.shape in {"DISK", "ELLIPSE"}, data.shape in {"RECTANGLE", "ELLIPSE"}
        width, height = np.linalg.norm(matrix[:3, :2], axis=0) * (data.size, data.size_y if oblong else data.size)
        shape, area = "ELLIPSE" if round_ else "RECTANGLE", width * height * (np.pi / 4.0 if round_ else 1.0)
        area *= rays_meet(eye.axes)
    else:
        width = height = 2.0 * data.shadow_soft_size
        shape, area = "DISC" if data.use_soft_falloff else "BALL", np.pi * data.shadow_soft_size**2
    radiance = eye.power / max(area, 1e-30)
    return ShownLamp(matrix[:3, 3], eye.axes, shape, (float(width), float(height)), tuple(radiance.tolist()), eye.cone,
                     data.type == "SPOT", lamp)


def lamps_before(mesh: bpy.types.Mesh, lamps: list[ShownLamp], mirrors: list) -> tuple[ShownLamp, ...]:
    """Return those of `lamps` that may be visible in front of the source, as one of the `mirrors` shows it.

    A lamp is left out if it is far from all light paths between the mirror and the source points, so that it adds no
    nodes. Only faces seen after one reflection count. The result is empty for a mesh that lacks faces or the attributes
    `KNOWN`.
    """
    lamps = [one for one in lamps if one.lamp is None or any(is_shown_in(one.lamp, mirror) for mirror in mirrors)]
    if not lamps or not len(mesh.polygons) or any(name not in mesh.attributes for name in KNOWN):
        return ()
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    bounces = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.attributes["bounces"].data.foreach_get("value", bounces)
    corners = corners.reshape(-1, 3)[bounces == 1]
    if not len(corners):
        return ()
    start, end = (vectors(mesh, name)[corners] for name in KNOWN[:2])
    # most beams are told from a lamp by their boxes along the scene's own axes
    low = np.minimum(start.min(axis=1), end.min(axis=1))
    high = np.maximum(start.max(axis=1), end.max(axis=1))
    return tuple(lamp for lamp in lamps if _is_before(
        lamp, start, end, np.flatnonzero(((lamp.place >= low - lamp.reach)
                                          & (lamp.place <= high + lamp.reach)).all(axis=1))))


def _is_before(lamp: ShownLamp, start: np.ndarray, end: np.ndarray, some: np.ndarray) -> bool:
    """Return True if the bounding sphere of a lamp may intersect one of the beams with indices `some`.

    Parameters
    ----------
    start, end : (n, 3, 3) float64
        Corners of the triangles at which each beam begins and ends.
    some : (k,) int64
        Indices of the beams to test.
    """
    for first in range(0, len(some), CHUNK):
        chunk = some[first:first + CHUNK]
        axes, lowest, highest = _slabs(start[chunk], end[chunk])
        at = axes @ lamp.place
        if ((at >= lowest - lamp.reach) & (at <= highest + lamp.reach)).all(axis=0).any():
            return True
    return False


def _slabs(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the extents of beams along axes that may separate them from a sphere.

    S. Gottschalk et al., "OBBTree", 1996: separating axes.

    Parameters
    ----------
    start, end : (n, 3, 3) float64
        Corners of the triangles at which each beam begins and ends.

    Returns
    -------
    axes : (k, n, 3) float64
        Unit vectors; zero where edges are parallel.
    lowest, highest : (k, n) float64
        Bounds of the beam along each axis.
    """
    ways = end - start
    sides = [corners[:, (1, 2, 0)] - corners for corners in (start, end)]
    axes = [ways.mean(axis=1), *(np.cross(side[:, 0], side[:, 1]) for side in sides),
            *(np.cross(side[:, k], way[:, k]) for side in sides for way in (ways, np.roll(ways, -1, axis=1))
              for k in range(3))]
    axes = np.stack(axes)
    axes /= np.maximum(np.linalg.norm(axes, axis=2, keepdims=True), 1e-30)
    along = np.einsum("kni,nci->knc", axes, np.concatenate((start, end), axis=1))
    return axes, along.min(axis=2), along.max(axis=2)
