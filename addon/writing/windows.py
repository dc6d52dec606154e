"""Mirrors that are windows to the virtual image behind them: hidden from the camera while there is one to be seen.

Blender has no way to hide an object as long as another exists: handlers look after whatever may have deleted a result.
"""
from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np
from bpy.app.handlers import persistent
from mathutils import Vector

from ...core import ReflectionMesh, View
from ..reading import is_opaque, is_result, materials_of, mirrors_of
from ..registration import Handlers

RAYS = 200          # number of rays that test the view through a window
NEARLY = 1e-4       # relative to a ray's length; objects so close to the image flicker with it
NEARER = 5e-4       # shift towards the eye, relative to the distance (orthographic: to the image's size); > 2 NEARLY
MOST_THROUGH = 100  # number of objects that a ray may pass through
TOO_SHORT = 100.0   # steps of single precision; on shorter rays the hit depends on rounding


def open_window(mirror: bpy.types.Object) -> None:
    """Make a window of the mirror: the camera must see the virtual image behind it."""
    if mirror.visible_camera and mirror.library is None:
        mirror.visible_camera = False
        mirror.reflection_mesh.camera_hidden = True


def close_window(mirror: bpy.types.Object) -> None:
    """Undo `open_window`; a mirror that the user hid stays hidden."""
    if mirror.reflection_mesh.camera_hidden and mirror.library is None:
        mirror.visible_camera = True
        mirror.reflection_mesh.camera_hidden = False


def set_window(result: bpy.types.Object, placement: str) -> None:
    """Make a window of a result's mirror, or close it, depending on the placement."""
    record = result.reflection_mesh
    record.window = placement == "VIRTUAL"
    for mirror in mirrors_of(result):
        (open_window if record.window else close_window)(mirror)


class InTheWay(NamedTuple):
    """Objects that hide a virtual image.

    Attributes
    ----------
    name : str
        Name of the object that hides most of the image, or an empty string.
    hidden : float
        Hidden share of the image, from 0 to 1.
    touches : bool
        True if an object touches the image, such as a floor that coincides with its own image.
    """

    name: str
    hidden: float
    touches: bool


def what_is_in_the_way(context: bpy.types.Context, view: View, result: ReflectionMesh, mirrors: list) -> InTheWay:
    """Find objects that hide a virtual image, with rays from the mirror.

    Parameters
    ----------
    view : View
        The view that the image was made for.
    mirrors : list of bpy.types.Object
        All mirrors that become windows.
    """
    if not len(result.positions):
        return InTheWay("", 0.0, False)
    depsgraph = context.evaluated_depsgraph_get()
    ways = _within_faces(result, view) if len(result.triangles) else _some(result.mirror_position, result.positions)
    found: Counter = Counter()
    touches, tried = False, 0
    for start, end in zip(*(ends.tolist() for ends in ways)):
        name, lies_before = _first_seen(context.scene, depsgraph, Vector(start), Vector(end), mirrors)
        found[name] += lies_before
        touches |= bool(name) and not lies_before
        tried += 1
    (name, most), = found.most_common(1)
    return InTheWay(name if most else "", found.total() / tried, touches)


def nearer(view: View, result: ReflectionMesh, found: InTheWay) -> ReflectionMesh:
    """If an object touches a virtual image, move the image slightly towards the eye so that it is visible. The picture
    stays the same.
    """
    if not found.touches:
        return result
    if view.orthographic:
        moved = result.positions - NEARER * np.ptp(result.positions, axis=0).max() * view.forward
    else:
        moved = view.eye + (1.0 - NEARER) * (result.positions - view.eye)
    return replace(result, positions=moved)


def _some(*places: np.ndarray) -> list[np.ndarray]:
    """Return evenly spaced entries of each array, `RAYS` at most."""
    some = np.unique(np.linspace(0, len(places[0]) - 1, RAYS).astype(np.int64))
    return [own[some] for own in places]


def _within_faces(result: ReflectionMesh, view: View) -> list[np.ndarray]:
    """Return two arrays (n, 3) of points on the mirror and on the image behind, spread evenly over the picture. Random
    vertices would be no fair sample: most faces are far away, but most pixels are near.
    """
    spots = view.pixels(result.mirror_position)[result.triangles]
    sides = spots[:, 1:] - spots[:, :1]
    area = np.nan_to_num(np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]))
    below = np.cumsum(area)
    chosen = np.minimum(np.searchsorted(below, (np.arange(RAYS) + 0.5) / RAYS * below[-1]), len(area) - 1)
    triangles = result.triangles[chosen]
    on_mirror = np.einsum("nk,nki->ni", _spread(len(chosen)), result.mirror_position[triangles])
    origins, ways = view.rays(view.pixels(on_mirror))
    a, b, c = np.moveaxis(result.positions[triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        away = ((a - origins) * normals).sum(axis=1) / (ways * normals).sum(axis=1)
        behind = origins + away[:, None] * ways
    known = np.isfinite(behind).all(axis=1) & (away > 0.0)
    return [on_mirror[known], behind[known]]


def _spread(count: int) -> np.ndarray:
    """Return weights (count, 3) of points spread evenly over a triangle (the sequence R2 of M. Roberts, 2018)."""
    u, v = ((0.5 + np.outer((0.7548776662466927, 0.5698402909980532), np.arange(count))) % 1.0)
    beyond = u + v > 1.0
    u, v = np.where(beyond, 1.0 - u, u), np.where(beyond, 1.0 - v, v)
    return np.stack((1.0 - u - v, u, v), axis=1)


def _first_seen(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, start: Vector, end: Vector,
                mirrors: list) -> tuple[str, bool]:
    """Cast a ray from `start` to `end` and return the first opaque object that the camera sees.

    Return its name, empty if there is none, and True if it lies clearly before `end`. Mirrors and results are ignored.
    """
    way = end - start
    # Blender's rays are in single precision, whose steps are wider far from the origin
    wide = max(map(abs, (*start, *end)))
    direction, step = way.normalized(), max(NEARLY * way.length, 2.0 * float(np.spacing(np.float32(wide))))
    if way.length < TOO_SHORT * step:
        return "", False
    at, end = start - step * direction, end + step * direction
    for _ in range(MOST_THROUGH):
        hit, place, _, _, obj, _ = scene.ray_cast(depsgraph, at, direction, distance=(end - at).dot(direction))
        if not hit:
            return "", False
        original = obj.original
        hides = original.visible_camera and not original.hide_render and original.reflection_mesh.role != "REFLECTION"
        if hides and original not in mirrors and any(map(is_opaque, materials_of(original) or [None])):
            return original.name, (end - place).dot(direction) > 2.0 * step
        at = place + step * direction
    return "", False


def close_abandoned_windows() -> None:
    """Show mirrors to the camera again if no result in any scene needs them as windows any more."""
    hidden = [obj for obj in bpy.data.objects if obj.reflection_mesh.camera_hidden]
    if not hidden:
        return
    # deleted objects that are still referenced exist without a scene
    shown = {mirror for scene in bpy.data.scenes for obj in scene.objects
             if is_result(obj) and _needs_window(obj.reflection_mesh) for mirror in mirrors_of(obj)}
    for obj in hidden:
        if obj not in shown:
            close_window(obj)


def _needs_window(record: bpy.types.PropertyGroup) -> bool:
    # results of earlier versions have no camera and did not record windows
    return (record.window and not any(record.aside)) or record.camera is None


@persistent
def _after_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # a render's depsgraph reports no changes of the file
    if depsgraph.mode == "VIEWPORT":
        close_abandoned_windows()


@persistent
def _after_opening(*_) -> None:
    # results may have been deleted where the extension was not
    close_abandoned_windows()


HANDLERS = Handlers((_after_change, "depsgraph_update_post"), (_after_opening, "load_post"))
register, unregister = HANDLERS.register, HANDLERS.unregister
