"""The eye: where view rays start, and where a point of the scene lands in the picture."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry import dot
from ..support import LARGEST, number, numbers
from .view_checks import LOOSE, check_placement, check_projection, picture_size

_NARROWEST = 1e-12
"""The least field of view, in radians."""


@dataclass(frozen=True)
class View:
    """A perspective or orthographic eye with its picture.

    Parameters
    ----------
    camera_to_world : (4, 4) float64
        Rigid placement of the eye, which looks along its own -Z with +Y up (Blender's and OpenGL's convention). Axes of
        unit length are asked for; that they stand at right angles and that they are right-handed is not, since Blender
        renders cameras that a parent shears or mirrors as they are.
    projection : (4, 4) float64
        Clip matrix in eye space, as OpenGL and `bpy.types.Object.calc_matrix_camera` define it: lens, shift, sensor
        fit and pixel aspect are all in it. Its last row tells a perspective (0 0 -1 0) from an orthographic eye
        (0 0 0 1).
    resolution : (width, height)
        Size of the picture in pixels, whole numbers up to 65536.

    Raises
    ------
    ValueError
        Where a matrix is none of these, or the resolution is no picture.

    Examples
    --------
    >>> import numpy as np
    >>> from core import View
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> view.pixels(np.zeros((1, 3))).round(6).tolist()
    [[160.0, 120.0]]
    """

    camera_to_world: np.ndarray
    projection: np.ndarray
    resolution: tuple[int, int]

    def __post_init__(self) -> None:
        for name in ("camera_to_world", "projection"):
            wrong = f"View.{name} must be a finite 4 x 4 matrix of numbers."
            matrix = numbers(getattr(self, name), (4, 4), wrong).copy()
            if not np.isfinite(matrix).all():
                raise ValueError(wrong)
            object.__setattr__(self, name, matrix)
        check_placement(self.camera_to_world)
        check_projection(self.projection)
        object.__setattr__(self, "resolution", picture_size(self.resolution))

    @classmethod
    def looking_at(cls, eye, target, resolution, *, field_of_view: float = 0.7, orthographic_scale: float = 0.0,
                   up=(0.0, 0.0, 1.0)) -> View:
        """An eye at `eye` that looks at `target`.

        Parameters
        ----------
        eye, target : (3,) float64
        resolution : (width, height)
            Size of the picture in pixels, whole numbers up to 65536.
        field_of_view : float
            In radians over the wider side of the picture, between 0 and pi.
        orthographic_scale : float
            Where it is greater than 0, the width in scene units of the wider side of an orthographic picture, whose
            field of view says nothing.
        up : (3,) float64
            Direction that is up in the picture. Where it does not tell, being zero or that of the view, Y takes its
            place, and X along Y.

        Raises
        ------
        ValueError
            Where one of these is no such number, or the eye is where it looks.
        """
        eye, target, up = _place(eye, "eye"), _place(target, "target"), _place(up, "up direction")
        if (eye == target).all():
            raise ValueError("The eye is where it looks; move the eye or the target.")
        resolution = picture_size(resolution)
        size = np.array(resolution, dtype=np.float64)
        back = _unit(eye - target)
        right = np.cross(_of_ordinary_length(up), back)
        for instead in ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0)):
            if np.linalg.norm(right) < 1e-9:
                right = np.cross(instead, back)
        right = _unit(right)
        placement = np.eye(4)
        placement[:3, 0], placement[:3, 1], placement[:3, 2], placement[:3, 3] = right, np.cross(back, right), back, eye
        return cls(placement, _lens(size / size.max(), field_of_view, orthographic_scale), resolution)

    @property
    def orthographic(self) -> bool:
        return bool(self.projection[3, 2] == 0.0)

    @property
    def eye(self) -> np.ndarray:
        """World position of the eye (for an orthographic one, a point of its plane)."""
        return self.camera_to_world[:3, 3]

    @cached_property
    def _inverse(self) -> np.ndarray:
        """Matrix (3, 3) from world to eye axes."""
        return np.linalg.inv(self.camera_to_world[:3, :3])

    @property
    def forward(self) -> np.ndarray:
        """Unit world direction in which the eye looks."""
        axis = -self.camera_to_world[:3, 2]
        return axis / np.linalg.norm(axis)

    def directions(self, points: np.ndarray) -> np.ndarray:
        """Return the directions (n, 3) of the view rays through `points` (n, 3), not normalised.

        These are the points minus the eye, or `forward` in an orthographic view.
        """
        if self.orthographic:
            return np.broadcast_to(self.forward, points.shape).copy()
        return points - self.eye

    def depths(self, points: np.ndarray) -> np.ndarray:
        """Return depths (n,) of `points` (n, 3): distances from the eye's plane along the eye's axis, in scene units.

        Depths are positive in front of the eye.
        """
        axes = self.camera_to_world[:3, :3]
        sheared = np.abs(axes.T @ axes - np.eye(3)).max() > 4.0 * LOOSE
        return dot(-self._inverse[2] if sheared else self.forward, (points - self.eye).T)

    def clip(self, points: np.ndarray) -> np.ndarray:
        """Return homogeneous clip coordinates (n, 4) of `points` (n, 3)."""
        return np.stack(self._seen(points, range(4)), axis=1)

    @cached_property
    def _towards(self) -> np.ndarray:
        """Matrix (4, 3) from vectors in the world to changes of the homogeneous clip coordinates."""
        return self.projection[:, :3] @ self._inverse

    def _seen(self, points: np.ndarray, wanted: Iterable[int]) -> list[np.ndarray]:
        """Return the `wanted` homogeneous clip coordinates, (n,) each, of `points` (n, 3).

        Rows are multiplied one by one: for so small a matrix NumPy's product would start threads that do not pay.
        """
        offset = np.subtract(points.T, self.eye[:, None], out=np.empty(points.T.shape))
        local = np.stack([dot(row, offset) for row in self._inverse])
        return [dot(self.projection[row], local) + self.projection[row, 3] for row in wanted]

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Project `points` (n, 3) to pixels (n, 2), from the picture's lower left corner, right and up.

        Points on the plane of a perspective eye have no picture: their positions are not finite.
        """
        *spots, depth = self._seen(points, (0, 1, 3))
        pixels = np.empty((len(points), 2))
        with np.errstate(divide="ignore", invalid="ignore"):
            for k, spot in enumerate(spots):
                spot /= depth
                spot *= 0.5
                spot += 0.5
                np.multiply(spot, self.resolution[k], out=pixels[:, k])
        return pixels

    def pixel_gradients(self, points: np.ndarray) -> np.ndarray:
        """Return the gradients (2, 3, n) of `pixels` at `points` (3, n), in pixels per scene unit.

        Entry [i, j] is the derivative of the position to the right (i = 0) or up (i = 1) by coordinate j.
        """
        towards = self._towards
        offset = points - self.eye[:, None]
        right, up, depth = (dot(towards[row], offset) + self.projection[row, 3] for row in (0, 1, 3))
        gradients = np.empty((2, *points.shape))
        with np.errstate(divide="ignore", invalid="ignore"):
            for gradient, along, row, size in zip(gradients, (right, up), towards, self.resolution):
                along /= depth
                scale = 0.5 * size / depth
                for component, own, deeper in zip(gradient, row, towards[3]):
                    np.multiply(own - along * deeper, scale, out=component)
        return gradients

    def rays(self, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return world origins and unit directions, (n, 3) each, of the view rays through `pixels` (n, 2)."""
        ndc = np.asarray(pixels, dtype=np.float64) / self.resolution * 2.0 - 1.0
        scale = np.diag(self.projection)[:2]
        rotation = self.camera_to_world[:3, :3]
        local = np.zeros((len(ndc), 3))
        if self.orthographic:
            local[:, :2] = (ndc - self.projection[:2, 3]) / scale
            origins = local @ rotation.T + self.eye
            return origins, np.broadcast_to(self.forward, origins.shape).copy()
        local[:, :2] = (ndc + self.projection[:2, 2]) / scale
        local[:, 2] = -1.0
        directions = local @ rotation.T
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return np.broadcast_to(self.eye, directions.shape).copy(), directions

    def starts(self, pixels: np.ndarray) -> np.ndarray:
        """Return the world positions (n, 3) of the near clipping plane on the view rays through `pixels` (n, 2)."""
        origins, ways = self.rays(pixels)
        slope, offset = self.projection[2, 2:]
        with np.errstate(divide="ignore", invalid="ignore"):
            near = (1.0 + offset) / slope if self.orthographic else offset / (slope - 1.0)
        if not np.isfinite(near):
            return origins
        # nothing is seen behind the eye's plane
        return origins + ways * (max(near, 0.0) / (ways @ self.forward))[:, None]


def _place(given, name: str) -> np.ndarray:
    wrong = f"The {name} must be three finite numbers up to 1e40."
    place = numbers(given, (3,), wrong)
    if not (np.abs(place) <= LARGEST).all():
        raise ValueError(wrong)
    return place


def _lens(size: np.ndarray, field_of_view: float, orthographic_scale: float) -> np.ndarray:
    """Make the projection matrix of a picture with sides of the lengths `size` (2,), the longer one 1."""
    width, angle = number(orthographic_scale), number(field_of_view)
    projection = np.zeros((4, 4))
    if not 0.0 <= width <= LARGEST or 0.0 < width < 1.0 / LARGEST:
        raise ValueError("The orthographic_scale must be a number of scene units from 1e-40 to 1e40, or 0 for a "
                         "perspective view.")
    if width > 0.0:
        projection[0, 0], projection[1, 1] = 2.0 / (width * size)
        projection[2, 2], projection[3, 3] = -1e-3, 1.0
        return projection
    if not _NARROWEST <= angle < np.pi:
        raise ValueError("The field_of_view must be an angle in radians, at least 1e-12 and less than pi; turn degrees "
                         "into radians.")
    projection[0, 0], projection[1, 1] = 1.0 / (np.tan(0.5 * angle) * size)
    projection[2, 2], projection[2, 3], projection[3, 2] = -1.0, -0.02, -1.0
    return projection


def _of_ordinary_length(vector: np.ndarray) -> np.ndarray:
    """Scale a vector by a power of two so that its largest component lies between 1 and 2; no digits change."""
    return np.ldexp(vector, 1 - np.frexp(np.abs(vector).max())[1])


def _unit(vector: np.ndarray) -> np.ndarray:
    vector = _of_ordinary_length(vector)
    return vector / np.linalg.norm(vector)
