"""The eye: where view rays start, and where a point of the scene lands in the picture."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class View:
    """A perspective or orthographic eye with its picture.

    Parameters
    ----------
    camera_to_world : (4, 4) float64
        Rigid placement of the eye, which looks along its own -Z with +Y up (Blender's and OpenGL's convention).
    projection : (4, 4) float64
        Clip matrix in eye space, as OpenGL and `bpy.types.Object.calc_matrix_camera` define it: lens, shift, sensor
        fit and pixel aspect are all in it. Its last row tells a perspective (0 0 -1 0) from an orthographic eye.
    resolution : (width, height)
        Size of the picture in pixels.
    """

    camera_to_world: np.ndarray
    projection: np.ndarray
    resolution: tuple[int, int]

    def __post_init__(self) -> None:
        for name in ("camera_to_world", "projection"):
            matrix = np.array(getattr(self, name), dtype=np.float64)
            if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
                raise ValueError(f"View.{name} must be a finite 4 x 4 matrix.")
            object.__setattr__(self, name, matrix)
        width, height = (int(size) for size in self.resolution)
        if width < 1 or height < 1:
            raise ValueError("View.resolution must be at least 1 x 1 pixels.")
        object.__setattr__(self, "resolution", (width, height))

    @classmethod
    def looking_at(cls, eye, target, resolution, *, field_of_view: float = 0.7, orthographic_scale: float = 0.0,
                   up=(0.0, 0.0, 1.0)) -> View:
        """An eye at `eye` that looks at `target`; `field_of_view` in radians over the wider side of the picture, or
        `orthographic_scale` > 0 for the width, in scene units, of an orthographic picture."""
        eye, target, up = (np.asarray(value, dtype=np.float64) for value in (eye, target, up))
        if (eye == target).all():
            raise ValueError("The eye is where it looks; move one of them.")
        back = (eye - target) / np.linalg.norm(eye - target)
        right = np.cross(up, back)
        if np.linalg.norm(right) < 1e-9:
            right = np.cross((0.0, 1.0, 0.0), back)
        right /= np.linalg.norm(right)
        placement = np.eye(4)
        placement[:3, 0], placement[:3, 1], placement[:3, 2], placement[:3, 3] = right, np.cross(back, right), back, eye
        width, height = resolution
        size = np.array([width, height]) / max(width, height)
        projection = np.zeros((4, 4))
        if orthographic_scale > 0.0:
            projection[0, 0], projection[1, 1] = 2.0 / (orthographic_scale * size)
            projection[2, 2], projection[3, 3] = -1e-3, 1.0
        else:
            projection[0, 0], projection[1, 1] = 1.0 / (np.tan(0.5 * field_of_view) * size)
            projection[2, 2], projection[2, 3], projection[3, 2] = -1.0, -0.02, -1.0
        return cls(placement, projection, resolution)

    @property
    def orthographic(self) -> bool:
        return bool(self.projection[3, 2] == 0.0)

    @property
    def eye(self) -> np.ndarray:
        """World position of the eye (for an orthographic one, a point of its plane)."""
        return self.camera_to_world[:3, 3]

    @property
    def forward(self) -> np.ndarray:
        """Unit world direction in which the eye looks."""
        axis = -self.camera_to_world[:3, 2]
        return axis / np.linalg.norm(axis)

    def directions(self, points: np.ndarray) -> np.ndarray:
        """View directions d of the rays through `points` (n, 3): P - E, not normalised, or the constant forward."""
        if self.orthographic:
            return np.broadcast_to(self.forward, points.shape).copy()
        return points - self.eye

    def depths(self, points: np.ndarray) -> np.ndarray:
        """Distances of `points` (n, 3) from the eye's plane, positive in front of it, in scene units."""
        return (points - self.eye) @ self.forward

    def clip(self, points: np.ndarray) -> np.ndarray:
        """Homogeneous clip coordinates (n, 4) of `points` (n, 3)."""
        rotation = self.camera_to_world[:3, :3]
        local = (points - self.eye) @ np.linalg.inv(rotation).T
        return local @ self.projection[:, :3].T + self.projection[:, 3]

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Picture positions (n, 2) of `points` (n, 3) in pixels, from the lower left corner, right and up.

        Points on the plane of a perspective eye have no picture: their positions are not finite.
        """
        clip = self.clip(points)
        with np.errstate(divide="ignore", invalid="ignore"):
            return (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * self.resolution

    def pixel_derivatives(self, points: np.ndarray, moves: np.ndarray) -> np.ndarray:
        """Pixels (n, 2) that the pictures of `points` (n, 3) move by where the points move by `moves` (n, 3), in the
        first order."""
        clip = self.clip(points)
        turned = moves @ np.linalg.inv(self.camera_to_world[:3, :3]).T @ self.projection[:, :3].T
        with np.errstate(divide="ignore", invalid="ignore"):
            change = (turned[:, :2] - clip[:, :2] / clip[:, 3:] * turned[:, 3:]) / clip[:, 3:]
        return 0.5 * change * self.resolution

    def rays(self, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """World origins and unit directions, (n, 3) each, of the rays through `pixels` (n, 2)."""
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
