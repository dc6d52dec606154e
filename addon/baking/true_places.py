"""Faces of results cut where they show patterns that shine, until what they show lies where the mirror has it.

Along a face a mirror shows what is far away more closely together than what is near; between a face's corners Blender
goes by equal steps. What a result says of places between, which its tolerance bounds, is what a flat mirror shows if it
is divided by how far away that is: so an eye sees what is flat (homogeneous coordinates).
"""
from __future__ import annotations

import bpy
import numpy as np

from ...core import View
from ..faults import Steps
from ..reading import DiffuseScene, numbers, vectors
from ..writing import edges_that_stray, halve_edges, place_of
from .fineness import FINER, fineness

NEARER = "Reflection Light Nearer"


def show_patterns_in_place(result: bpy.types.Object, view: View, scene: DiffuseScene) -> Steps[None]:
    """Cut those faces of a result that show what shines in a pattern, and tell each new point what it shows."""
    mesh, fine = result.data, fineness(scene) > FINER
    shining = {source for source, own in zip(scene.sources, fine, strict=True) if own}
    shows = np.array([entry.object in shining for entry in result.reflection_mesh.sources], dtype=bool)
    # without perspective results are placed so that all between the corners is in its place
    if view.orthographic or not shows.any() or "path_length" not in mesh.attributes:
        return
    nearer = _nearer(result, view)
    mesh.attributes.new(NEARER, "FLOAT", "POINT").data.foreach_set("value", nearer.astype(np.float32))
    _set_shown(mesh, vectors(mesh, "reflected_position") * nearer[:, None])
    try:
        yield from halve_edges(mesh, lambda: _straying(mesh, view, shows))
    finally:
        _set_shown(mesh, vectors(mesh, "reflected_position") / numbers(mesh, NEARER)[:, None])
        mesh.attributes.remove(mesh.attributes[NEARER])


def _nearer(result: bpy.types.Object, view: View) -> np.ndarray:
    """How much nearer to the eye than its image behind the mirror each point of a result lies, as a share (n,)."""
    mesh, matrix = result.data, np.array(place_of(result), dtype=np.float64)
    places = vectors(mesh, "position") @ matrix[:3, :3].T + matrix[:3, 3]
    own, mirror = (np.linalg.norm(at - view.eye, axis=1) for at in (places, vectors(mesh, "mirror_position")))
    return own / (mirror + numbers(mesh, "path_length"))


def _straying(mesh: bpy.types.Mesh, view: View, shows: np.ndarray) -> np.ndarray:
    """The edges of faces whose sources the table `shows` names, along which what they show lies beside its place."""
    edges = edges_that_stray(mesh, view.pixels(vectors(mesh, "mirror_position")), numbers(mesh, NEARER))
    chosen = np.zeros(len(mesh.edges), dtype=bool)
    around = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.attributes[".corner_edge"].data.foreach_get("value", around)
    # all faces are triangles
    chosen[around.reshape(-1, 3)[shows[numbers(mesh, "source_object")]]] = True
    return edges[chosen[edges]]


def _set_shown(mesh: bpy.types.Mesh, places: np.ndarray) -> None:
    mesh.attributes["reflected_position"].data.foreach_set("vector", places.astype(np.float32).reshape(-1))
