"""The resulting caustic mesh: faces on the receivers with the irradiance at their corners."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class CausticMesh:
    """The caustics of one lamp and one mirror, in world space and scene units.

    Faces of several images, and of both parities, overlap where light arrives by more than one path: their irradiance
    adds up.

    Attributes
    ----------
    positions : (n, 3) float64
        Vertices on the receivers.
    triangles : (m, 3) int64
        Faces; their normals point to the lit side.
    irradiance : (m, 3) float64
        Irradiance at the corners of the faces, for a perfect mirror: W/m2 for a lamp of 1 W/sr times its pattern, or
        for a sun of 1 W/m2. Interpolated over a face it integrates to the face's flux. Finite everywhere.
    flux : (m,) float64
        Solid angle of each face in the lamp's picture, times the pattern's mean; for a sun, the face's area
        perpendicular to the light.
    mirror_position : (n, 3) float64
        Places on the first mirror that the light comes from.
    image_parity : (n,) int8
        +1, or -1 for mirrored images, or 0 on a caustic.
    met : (m, b) int64
        Indices of the mirror triangles that the light of each face hits, in order; -1 after the last. Triangles of
        `mirrors` are numbered after those of `mirror`.
    cosine : (m, 3, b) float64
        Cosine of the angle of incidence at these triangles, for each corner; negative at a triangle's back.
    direction : (m, 3, 3) float64
        Unit direction of the light that arrives at each corner.
    source_face : (m,) int64
        Triangle of the receivers that each face lies on.
    source_weights : (m, 3, 3) float64
        Barycentric coordinates of each corner of each face in that triangle.
    bounces : (m,) int8
        Number of mirrors that the light has hit.
    counts : dict
        Counts of the steps, for reports.

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
