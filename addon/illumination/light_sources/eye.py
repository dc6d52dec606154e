"""One point on a lamp, and the distribution of its light."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....core import Lamp, TriangleMesh

AT_ONCE = 1 << 22
RIM, BETWEEN = 256, 1.001  # places on the rim of a spot lamp's cone, and how much wider it may be between them
NARROWEST = 4e-3  # radians: what a lamp's light is split for, as if its cone were no narrower


@dataclass(frozen=True)
class Eye:
    """A point on a lamp.

    Attributes
    ----------
    lamp : core.Lamp
    power : (3,) float64
        Red, green and blue: intensity along the axis in W/sr, or a sun's irradiance in W/m2.
    axes : (3, 3) float64
        Axes x, y, z of the lamp in world space, as unit columns; orthogonal unless the lamp is sheared. It shines along
        -z. For a spot lamp, whose cone is stretched by its scale, `directions @ axes` are directions in its own space.
    kind : str
        See `bpy.types.Light.type`.
    cone : tuple of float
        Spot lamp: cosine of half its angle, and width of the blend. Area lamp: cotangent of half its spread, and the
        factor that restores its power.
    facets : (k, 3) float64, optional
        Mesh that is taken as one point: normals of its triangles, as long as their areas.
    body : core.TriangleMesh, optional
        Parts of the lamp that may occlude this point.
    soft : (3,) float64 and float, optional
        Middle and radius of a point or spot lamp with a soft falloff, where that matters.
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
        """Return the lamp with its distribution of light."""
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
        """Return the axis (3,) of a spot lamp's cone in world space, and the largest and smallest angles of its rim."""
        sine, angle = np.sqrt(max(1.0 - self.cone[0]**2, 0.0)), np.linspace(0.0, 2.0 * np.pi, RIM, endpoint=False)
        rim = np.stack((sine * np.cos(angle), sine * np.sin(angle), np.full(RIM, -self.cone[0])))
        axis, rim = (np.linalg.solve(self.axes.T, ways) for ways in (np.array((0.0, 0.0, -1.0)), rim))
        axis, rim = axis / np.linalg.norm(axis), rim / np.linalg.norm(rim, axis=0)
        off = np.arctan2(np.linalg.norm(np.cross(axis, rim.T), axis=1), axis @ rim)
        return axis, float(off.max()) * BETWEEN, float(off.min())

    def share(self, places: np.ndarray) -> np.ndarray:
        """Return the share of the power that goes towards `places` (..., 3)."""
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
        """Return the light at `places` (..., 3) of a disc that faces each of them, relative to that of a point at its
        middle.
        """
        if self.soft is None:
            return np.ones(places.shape[:-1])
        middle, radius = self.soft
        squared = ((places - middle)**2).sum(axis=-1)
        return squared / (squared + radius**2)

    def _seen_area(self, places: np.ndarray) -> np.ndarray:
        """Return the projected area (...) of the mesh `facets` as seen from `places` (..., 3), in square scene units.

        That is the area of the mesh's outline in a parallel projection from the lamp towards the place. A ray through a
        convex mesh meets two triangles that face each other, or only one if it passes an opening. The sum of all
        projected areas counts the former part twice, and the absolute value of their signed sum counts the latter part
        alone. So half of both together is the area. It is exact for convex meshes that are closed or have one flat
        opening.
        """
        way = (places - self.lamp.place).reshape(-1, 3)
        way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
        through = np.abs(way @ self.facets.sum(axis=0))
        step = max(AT_ONCE // len(self.facets), 1)
        for start in range(0, len(way), step):
            through[start:start + step] += np.abs(way[start:start + step] @ self.facets.T).sum(axis=1)
        return (0.5 * through).reshape(places.shape[:-1])


def across(way: np.ndarray) -> np.ndarray:
    """Return two orthogonal unit vectors perpendicular to a direction (3,), as columns (3, 2)."""
    length = np.linalg.norm(way)
    if not length > 0.0:
        return np.eye(3)[:, :2]
    way = way / length
    other = np.eye(3)[np.argmin(np.abs(way))]
    first = np.cross(way, other)
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(way, first)), axis=1)


def facing(way: np.ndarray) -> np.ndarray:
    """Return three orthogonal unit vectors as columns (3, 3), the last one along a direction (3,)."""
    first, second = across(way).T
    return np.stack((first, second, np.cross(first, second)), axis=1)
