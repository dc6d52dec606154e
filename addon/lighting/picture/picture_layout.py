"""Where on a result the picture of light lies: a UV map, on faces small enough for it, and the colours of its points.

A place in a picture is not linear on a face that is seen at an angle, a UV map is: such faces are cut. Homogeneous
coordinates would need no cut, but exporters and solid view know UV maps only.
"""
from __future__ import annotations

import bpy
import numpy as np

from ....core import View
from ...faults import Steps
from ...reading.materials import glows
from ...writing import edges_that_stray, halve_edges, light_layer, light_points, place_of
from .window import Window

COLOUR = "Reflection Light Colour"
SHINING = "Reflection Light Shining"
WRITING = "Writing"


def lay_out(result: bpy.types.Object, view: View, window: Window, texels: np.ndarray | None) -> Steps[None]:
    """Tell each point of a result where in the window the view sees it, and what colour it has there, in steps.

    Parameters
    ----------
    texels : (height, width, 3) float32 or None
        What the window shows, where that is known.
    """
    mesh = result.data
    matrix = np.array(place_of(result), dtype=np.float64)
    dense = 1.0 if texels is None else len(texels) / window.height
    yield from halve_edges(mesh, lambda: _straying(mesh, view, matrix, dense))
    yield 0.0, WRITING
    spots = _in_window(_clip(mesh, view, matrix), view, window)
    _write_spots(mesh, spots)
    _write_shining(result)
    yield 0.0, WRITING
    if texels is not None:
        _write_colours(mesh, spots, texels)


def _straying(mesh: bpy.types.Mesh, view: View, matrix: np.ndarray, dense: float = 1.0) -> np.ndarray:
    """The edges along which a picture of so many texels a pixel is not linear, by texels."""
    clip = _clip(mesh, view, matrix)
    with np.errstate(divide="ignore", invalid="ignore"):
        spots = 0.5 * clip[:, :2] / clip[:, 3:] * view.resolution
    return edges_that_stray(mesh, dense * spots, clip[:, 3])


def _clip(mesh: bpy.types.Mesh, view: View, matrix: np.ndarray) -> np.ndarray:
    """Homogeneous places (n, 4) of a mesh's points in the view's picture."""
    places = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", places.reshape(-1))
    return view.clip(places.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3])


def _in_window(clip: np.ndarray, view: View, window: Window) -> np.ndarray:
    """Places (n, 2) in the window, from 0 to 1."""
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = 0.5 * (clip[:, :2] / clip[:, 3:] + 1.0) * view.resolution
    return np.nan_to_num((pixels - (window.column, window.row)) / (window.width, window.height))


def _write_spots(mesh: bpy.types.Mesh, spots: np.ndarray) -> None:
    """As a UV map; loose points, which have none, know them by themselves."""
    if len(mesh.loops):
        layer = light_layer(mesh)
        corners = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
        layer.uv.foreach_set("vector", spots[corners].astype(np.float32).reshape(-1))
        layer.active = layer.active_render = True
    else:
        light_points(mesh).data.foreach_set("vector", spots.astype(np.float32).reshape(-1))


def shining_slots(result: bpy.types.Object) -> set[int]:
    """The slots of a result whose faces show what has a light of its own, be it a part of what is seen; none where it
    has points alone."""
    mesh = result.data
    return {number for number, material in enumerate(mesh.materials) if len(mesh.polygons) and glows(material)}


def _write_shining(result: bpy.types.Object) -> None:
    """Whether a face shows what shines, as 1 or 0."""
    mesh, slots = result.data, shining_slots(result)
    if not slots:
        return
    index = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", index)
    known = mesh.attributes.get(SHINING) or mesh.attributes.new(SHINING, "FLOAT", "FACE")
    known.data.foreach_set("value", np.isin(index, list(slots)).astype(np.float32))


def _write_colours(mesh: bpy.types.Mesh, spots: np.ndarray, texels: np.ndarray) -> None:
    """The nearest texels, as what solid view shows by attribute."""
    height, width = texels.shape[:2]
    column, row = np.clip(spots * (width, height), 0, (width - 1, height - 1)).astype(np.int64).T
    colours = np.ones((len(spots), 4), dtype=np.float32)
    colours[:, :3] = texels[row, column]
    known = mesh.color_attributes.get(COLOUR) or mesh.color_attributes.new(COLOUR, "FLOAT_COLOR", "POINT")
    known.data.foreach_set("color", colours.reshape(-1))
    mesh.color_attributes.active_color = known
    mesh.color_attributes.render_color_index = mesh.color_attributes.active_color_index
