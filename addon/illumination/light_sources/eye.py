"""One place on a lamp, and how much of its light goes where."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....core import Lamp, TriangleMesh

AT_ONCE = 1 << 22
RIM, BETWEEN = 256, 1.001  # places on the rim of a spot lamp's cone, and how much wider it may be between them
NARROWEST = 4e-3  # radians: what a lamp's light is split for, as if its cone were no narrower


@dataclass(frozen=True)
class Eye:
    """A place on a lamp.

    Attributes
    ----------
    lamp : core.Lamp
    power : (3,) float64
        Red, green and blue: intensity along the axis in W/sr, or a sun's irradiance in W/m2.
    axes : (3, 3) float64
        World axes x, y, z of the lamp, unit columns, at right angles unless it is sheared; it shines along -z. Of a
        spot lamp, whose cone is drawn out as it is scaled, what turns ways @ axes into its own space.
    kind : str
        As `bpy.types.Light.type`.
    cone : tuple of float
        Of a spot lamp the cosine of half its angle and the width of the blend beside it; of an area lamp the
        cotangent of half its spread and what makes up for it.
    facets : (k, 3) float64, optional
        Of a mesh that is taken as one place: its triangles' normals, as long as their area.
    body : core.TriangleMesh, optional
        What of the lamp itself may stand before this place.
    soft : (3,) float64 and float, optional
        Middle and radius of a point or spot lamp with a soft falloff, where that counts.
    """

    lamp: Lamp
    power: np.ndarray
    axes: np.ndarray
    kind: str
    cone: tuple[float, float]
    facets: np.ndarray | None = None
    body: TriangleMesh | None = None
    soft: tuple[np.ndarray, float] | None = None

    @property
    def shining(self) -> Lamp:
        """The lamp with its pattern."""
        if self.kind in {"POINT", "SUN"} and self.facets is None and self.soft is None:
            return self.lamp
        if self.facets is not None or self.kind == "POINT":
            return replace(self.lamp, pattern=self.share)
        if self.kind == "SPOT":
            axis, half, least = self._drawn_cone()
            return replace(self.lamp, pattern=self.share, narrow=max(0.5 * least, NARROWEST), cone=(axis, half))
        half = float(np.arctan2(1.0, max(self.cone[0], 0.0)))
        narrow = 0.5 * half if self.cone[0] > 0.0 else np.inf
        return replace(self.lamp, pattern=self.share, narrow=max(narrow, NARROWEST), cone=(-self.axes[:, 2], half))

    def _drawn_cone(self) -> tuple[np.ndarray, float, float]:
        """The axis (3,) of a spot lamp's cone in the world, and the angles from it that its rim has at most, and at
        least."""
        sine, angle = np.sqrt(max(1.0 - self.cone[0]**2, 0.0)), np.linspace(0.0, 2.0 * np.pi, RIM, endpoint=False)
        rim = np.stack((sine * np.cos(angle), sine * np.sin(angle), np.full(RIM, -self.cone[0])))
        axis, rim = (np.linalg.solve(self.axes.T, ways) for ways in (np.array((0.0, 0.0, -1.0)), rim))
        axis, rim = axis / np.linalg.norm(axis), rim / np.linalg.norm(rim, axis=0)
        off = np.arctan2(np.linalg.norm(np.cross(axis, rim.T), axis=1), axis @ rim)
        return axis, float(off.max()) * BETWEEN, float(off.min())

    def share(self, places: np.ndarray) -> np.ndarray:
        """How much of the power goes towards `places` (..., 3)."""
        if self.facets is not None:
            return self._seen_area(places)
        if self.kind in {"POINT", "SUN"}:
            return self._softly(places)
        way = places - self.lamp.place
        own = way @ self.axes
        ahead = -own[..., 2] / np.maximum(np.linalg.norm(own if self.kind == "SPOT" else way, axis=-1), 1e-300)
        if self.kind == "SPOT":
            # the blend is Cycles' smoothstep (`spot_light_attenuation` of its kernel)
            t = np.clip((ahead - self.cone[0]) / self.cone[1], 0.0, 1.0)
            return t * t * (3.0 - 2.0 * t) * self._softly(places)
        cosine = np.maximum(ahead, 0.0)
        if self.cone[0] <= 0.0:
            return cosine
        # a spread below 180 degrees (`area_light_spread_attenuation` of Cycles' kernel)
        tangent = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)) / np.maximum(cosine, 1e-12)
        return cosine * np.maximum(1.0 - self.cone[0] * tangent, 0.0) * self.cone[1]

    def _softly(self, places: np.ndarray) -> np.ndarray:
        """How much of what its middle would send a disc sends that faces each of `places` (..., 3)."""
        if self.soft is None:
            return np.ones(places.shape[:-1])
        middle, radius = self.soft
        squared = ((places - middle)**2).sum(axis=-1)
        return squared / (squared + radius**2)

    def _seen_area(self, places: np.ndarray) -> np.ndarray:
        """The area of the mesh as it is seen from `places` (..., 3): a way through a convex one meets two triangles
        that face each other, or one at its open side."""
        way = (places - self.lamp.place).reshape(-1, 3)
        way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
        through = np.abs(way @ self.facets.sum(axis=0))
        step = max(AT_ONCE // len(self.facets), 1)
        for start in range(0, len(way), step):
            through[start:start + step] += np.abs(way[start:start + step] @ self.facets.T).sum(axis=1)
        return (0.5 * through).reshape(places.shape[:-1])


def across(way: np.ndarray) -> np.ndarray:
    """Two unit vectors across a way (3,), as columns (3, 2)."""
    length = np.linalg.norm(way)
    if not length > 0.0:
        return np.eye(3)[:, :2]
    way = way / length
    other = np.eye(3)[np.argmin(np.abs(way))]
    first = np.cross(way, other)
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(way, first)), axis=1)


def facing(way: np.ndarray) -> np.ndarray:
    """Three unit vectors at right angles, as columns (3, 3), the last one along a way (3,)."""
    first, second = across(way).T
    return np.stack((first, second, np.cross(first, second)), axis=1)
