"""General three-ray cameras: one for each mirror triangle that the view can see.

A camera is a mirror triangle V_i with the reflected rays R_i at its corners; between them both are interpolated:
Q(W) = sum W_i V_i, R(W) = sum W_i R_i (C. Mei, V. Popescu, E. Sacks, GRAPP 2007). Corners with the same vertex and the
same normal are shared, so that neighbouring cameras are continuous across their edge.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import TriangleMesh, borders, connected, following, numbered, solid_angles
from ..views import View
from .mirror_map import MirrorMap
from .reflection_map import ReflectionMap


@dataclass(frozen=True)
class Cameras:
    """Three-ray cameras on shared corners.

    Attributes
    ----------
    corners : (n, 3) int64, each camera's corners, as indices into the columns below
    face : (n,) int64
        The mirror triangle that the camera lies on.
        After several bounces, the chain of mirror triangles.
    places : (3, c) float64, corners on the first mirror, in world space
    rays : (3, c) float64, R, reflected rays of the corners, as long as the whole path from the eye
    origins : (3, c) float64, V, ray origins on the last mirror, in world space; after one bounce equal to `places`
    mirror_map : ReflectionMap, the true map of the rays
    """

    corners: np.ndarray
    face: np.ndarray
    places: np.ndarray
    rays: np.ndarray
    origins: np.ndarray
    mirror_map: ReflectionMap

    def __len__(self) -> int:
        return len(self.face)

    def select(self, chosen: np.ndarray) -> Cameras:
        return replace(self, corners=self.corners[chosen], face=self.face[chosen])

    def replaced(self, corners: np.ndarray, face: np.ndarray, places: np.ndarray, origins: np.ndarray,
                 rays: np.ndarray) -> Cameras:
        """Return m other cameras on the c corners of these and on k new corners, with the same map.

        Parameters
        ----------
        corners : (m, 3) int64
            The corners of each camera: numbers below c for corners of these cameras, c + i for new corner i.
        face : (m,) int64, mirror triangle, or chain of mirror triangles, that each camera lies on
        places, origins, rays : (3, k) float64
            The new corners, as in the attributes of `Cameras`. After one bounce `origins` is ignored.
        """
        places = np.concatenate((self.places, places), axis=1)
        return Cameras(corners, face, places, np.concatenate((self.rays, rays), axis=1),
                       places if self.mirror_map.bounce == 1 else np.concatenate((self.origins, origins), axis=1),
                       self.mirror_map)

    @property
    def view(self) -> View:
        """The view that the cameras belong to."""
        return self.mirror_map.view


def visible_triangles(view: View, mirror: TriangleMesh) -> np.ndarray:
    """Return the indices of the mirror's triangles that the view may see.

    Triangles without an area are left out. On a closed mirror only outer sides count, or inner sides if the eye is
    inside. Open mirrors show both sides, as in Cycles. So does a closed mirror that is cut by the plane of an
    orthographic eye, because some rays start inside of it.
    """
    areal = np.flatnonzero(mirror.areal)
    triangles = mirror.triangles[areal]
    corners = mirror.positions[triangles]
    towards = _towards(view, corners)
    visible = towards != 0.0
    if _closed(triangles) and not (view.orthographic and (view.depths(mirror.positions[mirror.used]) <= 0.0).any()):
        visible &= towards * _outwards(view, mirror.positions, triangles, corners) > 0.0
    return areal[visible]


def not_edge_on(view: View, mesh: TriangleMesh) -> np.ndarray:
    """Return True (m,) for triangles with an area that the view does not see edge-on."""
    return mesh.areal & (_towards(view, mesh.positions[mesh.triangles]) != 0.0)


def _towards(view: View, corners: np.ndarray) -> np.ndarray:
    """Return the component (m,) of triangles' normals towards the eye: negative for triangles seen from behind.

    `corners` (m, 3, 3) are in world space.
    """
    return -np.einsum("ij,ij->i", view.directions(corners[:, 0]), _normals(corners))


def _outwards(view: View, positions: np.ndarray, triangles: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return a sign (n,): positive if a triangle's normal points out of its closed body, negative if into it.

    For bodies with the eye inside, such as a room, the sign is reversed.

    Parameters
    ----------
    positions : (v, 3) float64
    triangles : (n, 3) int64
    corners : (n, 3, 3) float64, corners of the triangles
    """
    body = connected(triangles)
    sixfold = np.einsum("ij,ij->i", corners[:, 0] - corners.mean(axis=(0, 1)), _normals(corners))
    volume = np.bincount(body, sixfold)
    if not view.orthographic:
        owner = np.full(len(positions), -1)
        owner[triangles] = body[:, None]
        used = np.flatnonzero(owner >= 0)
        # only bodies with the eye in their bounding box can contain it
        near = np.ones(len(volume), dtype=bool)
        for side in (*(positions[used] > view.eye).T, *(positions[used] < view.eye).T):
            near &= np.bincount(owner[used], side) > 0.0
        own = np.flatnonzero(near[body])
        around = np.bincount(body[own], solid_angles(view.eye, corners[own]), minlength=len(volume))
        volume = np.where(np.abs(around) > 2.0 * np.pi, -volume, volume)
    return volume[body]


def _normals(corners: np.ndarray) -> np.ndarray:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _closed(triangles: np.ndarray) -> bool:
    """Return True for a closed surface: each directed edge has exactly one opposite."""
    if not len(triangles):
        return False
    count = int(triangles.max()) + 1
    if borders(triangles, count).any():
        return False
    edge = np.sort((triangles * count + following(triangles)).ravel())
    return bool((edge[1:] != edge[:-1]).all())


def three_ray_cameras(mirror_map: MirrorMap, mirror: TriangleMesh, faces: np.ndarray) -> Cameras:
    """Make cameras on the mirror's triangles `faces` (n,); corners with the same vertex and normal are shared."""
    corner_face = np.repeat(faces, 3)
    corner = np.tile(np.arange(3), len(faces))
    if mirror_map.parallel:
        shared = np.arange(len(corner_face))
        first = shared
    else:
        vertex = mirror.triangles[faces].ravel()
        normal = mirror.corner_normals[faces].reshape(-1, 3)
        # corners with lifted rays are not shared, because their rays depend on the flat face
        lifted = mirror_map.lifted(corner_face, np.stack((corner == 1, corner == 2)).astype(np.float64))
        keys = np.stack((*normal.T, np.where(lifted, corner_face, -1), vertex))
        order = np.lexsort(keys)
        new = np.ones(len(order), dtype=bool)
        new[1:] = (keys[:, order[1:]] != keys[:, order[:-1]]).any(axis=0)
        shared = np.empty(len(order), dtype=np.int64)
        shared[order] = np.cumsum(new) - 1
        first = order[new]
    uv = np.stack((corner[first] == 1, corner[first] == 2)).astype(np.float64)
    face = corner_face[first]
    places = mirror_map.places(face, uv)
    # start each camera at its lowest corner by x, y, z, so that splitting does not depend on the order of its corners
    rank = numbered(len(first), np.lexsort(places[::-1]))
    corners = shared.reshape(-1, 3)
    turn = (np.argmin(rank[corners], axis=1)[:, None] + np.arange(3)) % 3
    return Cameras(np.take_along_axis(corners, turn, axis=1), faces, places, mirror_map.rays(face, uv),
                   places, mirror_map)
