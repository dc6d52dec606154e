"""The result: faces on what is lit, each with the irradiance at its corners."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class CausticMesh:
    """The light of one lamp that one mirror throws, in world space and scene units.

    Faces of several images, and of both parities, lie over each other where the light comes more than one way: their
    irradiance adds up.

    Attributes
    ----------
    positions : (n, 3) float64
        On what is lit.
    triangles : (m, 3) int64
        Turned to the side that is lit.
    irradiance : (m, 3) float64
        At the corners of the faces, of a perfect mirror: W/m2 for a lamp of 1 W/sr times its pattern, or for a sun
        of 1 W/m2.
        Interpolated over a face it amounts to the face's flux. Finite everywhere.
    flux : (m,) float64
        The solid angle of each face in the lamp's picture, times the pattern's mean; of a sun the face's area across
        the light.
    mirror_position : (n, 3) float64
        Where on the mirror the light comes from.
    image_parity : (n,) int8
        +1 or -1 (turned over), 0 on a caustic.
    met : (m, b) int64
        Triangles of the mirrors that the light of each face meets, in its order, those of `mirrors` behind those of
        `mirror`; -1 where it meets no more.
    cosine : (m, 3, b) float64
        Of the angles at which it meets them, at the corners; negative where it meets a triangle's back.
    direction : (m, 3, 3) float64
        In which the light comes to the corners; unit vectors.
    source_face : (m,) int64
        Triangle of what is lit.
    source_weights : (m, 3, 3) float64
        Barycentric coordinates of each corner of each face in its source triangle.
    bounces : (m,) int8
        How many mirrors the light has met.
    counts : dict

    Examples
    --------
    >>> import numpy as np
    >>> from core import Lamp, TriangleMesh, caustics
    >>> mirror = TriangleMesh(np.array([[0, -1, 1], [0, 1, 1], [0, 0, 2.0]]), np.array([[0, 1, 2]]))
    >>> floor = TriangleMesh(np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]]))
    >>> mesh = caustics(Lamp.shining((-1, 0, -1)), mirror, floor)
    >>> mesh.irradiance.round(3).min().item(), mesh.irradiance.round(3).max().item()  # 1 W/m2 at 45 degrees
    (0.707, 0.707)
    >>> mesh.flux.sum().round(6).item()  # the mirror's area of 1, seen at 45 degrees
    0.707107
    """

    positions: np.ndarray
    triangles: np.ndarray
    irradiance: np.ndarray
    flux: np.ndarray
    mirror_position: np.ndarray
    image_parity: np.ndarray
    met: np.ndarray
    cosine: np.ndarray
    direction: np.ndarray
    source_face: np.ndarray
    source_weights: np.ndarray
    bounces: np.ndarray
    counts: dict = field(default_factory=dict)
