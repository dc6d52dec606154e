"""What all reflection maps share: Newton's method for what is seen through them.

A reflection map leads from a place (u, v) on a flat mirror triangle, where the eye sees it, to the ray that leaves the
last mirror: its origin O and direction R. After one reflection O is the place Q itself. A point P is seen where
P = O(u, v) + s R(u, v), s > 0.
"""
from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np

from ..geometry import cross, dot, norm, solve
from ..views import View
from .mirror_surface import ALONG_UV, MirrorSurface, Way

SETTLED = 1e-9  # of a triangle's side, or of s: after a shorter step of Newton's method the next is rounding alone
DIFFERENCE = 1e-5  # of a triangle's side: step of the difference quotients for bent rays
ARRIVED = 1e-10  # of the path and the viewing distance: by how much a ray that Newton's method found may miss


class ReflectionMap(ABC):
    """Rays at places (u, v) of `face`: a triangle of the mirror, or a chain of triangles where there are more bounces.

    Attributes
    ----------
    view : View, who looks
    bounce : int, how many mirrors light has met when it leaves the last one: 1 for what the eye sees in the mirror
    parallel : bool, every face sends all its rays along one direction; the map jumps between faces
    orthographic : bool, rays are unit vectors, and s is a length
    grazing : (m,) bool, faces on which some ray may be lifted
    """

    view: View
    bounce: int
    parallel: bool
    orthographic: bool
    grazing: np.ndarray

    @property
    def unit_rays(self) -> bool:
        """Whether rays are unit vectors and s is a length, instead of rays as long as the way from the eye."""
        return self.orthographic or self.parallel

    @abstractmethod
    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """(u, v) as (2, n) of `places` (3, n) on the planes of the triangles that the eye sees."""

    @abstractmethod
    def places(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Q as (3, n), where the eye sees the mirror."""

    @abstractmethod
    def spans(self, face: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (3, n) of Q along u and along v."""

    @abstractmethod
    def first(self, face: np.ndarray) -> np.ndarray:
        """The triangle (n,) of the mirror that the eye sees."""

    @abstractmethod
    def last(self, face: np.ndarray) -> tuple[MirrorSurface, np.ndarray]:
        """The surface that the rays leave last, and which of its triangles (n,)."""

    @abstractmethod
    def rays(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """R as (3, n), not normalised: as long as the whole way from the eye (1 in orthographic views)."""

    @abstractmethod
    def leave(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """O and R, (3, n) each."""

    @abstractmethod
    def met_later(self, face: np.ndarray, uv: np.ndarray) -> list[np.ndarray]:
        """Places (3, n) on each mirror that the ray from Q meets later, the last of them O. None after one bounce."""

    @abstractmethod
    def leaving(self, face: np.ndarray, uv: np.ndarray, bent: bool = True) -> list[np.ndarray]:
        """Directions (3, n) in which the ray leaves each mirror that it meets, the nearest to the eye first; R last.
        Those, without `bent`, in which it would leave each if it were not lifted there."""

    @abstractmethod
    def lifted(self, face: np.ndarray, uv: np.ndarray, slack: float = 0.0) -> np.ndarray:
        """Whether the rays (n,) would enter their flat faces and are turned until they clear them, or, by `slack` of
        their rise, all but are."""

    @abstractmethod
    def linearise(self, face: np.ndarray, uv: np.ndarray, *ways: Way) -> tuple:
        """O, R, and for each of the `ways` (2, n) in (u, v) the derivatives of both along it, all (3, n)."""

    @abstractmethod
    def turned_before(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray | float:
        """`turned` of the mirrors before the last one, at the last one; 1 where there are none."""

    def _bend(self, part: np.ndarray, places: tuple[np.ndarray, np.ndarray], ways: tuple[Way, ...], rays: np.ndarray,
              changes: list[np.ndarray]) -> None:
        """Put bent rays, and by difference quotients what they change by along the `ways`, in place of unbent ones: of
        the `part` (m,) of all `places`, their faces (n,) and (u, v)."""
        if not len(part):
            return
        face, uv = places[0][part], places[1][:, part]
        rays[:, part] = self.rays(face, uv)
        for way, change in zip(ways, changes):
            step = DIFFERENCE * np.broadcast_to(way, places[1].shape)[:, part]
            after, before = (self.rays(face, uv + sign * step) for sign in (1.0, -1.0))
            change[:, part] = (after - before) / (2.0 * DIFFERENCE)

    def locate(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray, points: np.ndarray,
               steps: int = 4) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method for O(u, v) + s R(u, v) = P from a near start, `points` P as (3, n); returns uv and s."""
        def stepped(now: np.ndarray, face: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            origin, ray, ((ou, ru), (ov, rv)) = self.linearise(face, now[:2], *ALONG_UV)
            s = now[2]
            step = solve(ou + s * ru, ov + s * rv, ray, points - origin - s * ray)
            # a step longer than the triangle tells a start too far off: keep its direction only
            step /= np.maximum(1.0, np.maximum(np.abs(step[0]), np.abs(step[1])))
            return now + step, step

        found = _newton(stepped, np.concatenate((uv, s[None])), (face, points), steps)
        return found[:2], found[2]

    def meet(self, face: np.ndarray, line: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray],
             guess: tuple[np.ndarray, np.ndarray], steps: int = 5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Newton's method for the ray from the mirror's `line`, its start and end (2, n) in (u, v), that meets the
        `other` line P + r E, P and E (3, n), from a near guess of t and s; returns t along the mirror's line, r along
        the other, and s."""
        (start, end), (point, edge), (t, s) = line, other, guess

        def stepped(now: np.ndarray, face: np.ndarray, start: np.ndarray, way: np.ndarray, point: np.ndarray,
                    edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            t, r, s = now
            origin, ray, ((move, change),) = self.linearise(face, start + t * way, way)
            moved = solve(move + s * change, ray, -edge, point - origin - s * ray)
            # s is a length in orthographic views: only t can tell a step that is too long
            moved[:2] /= np.maximum(1.0, np.abs(moved[0]))
            return np.stack((t + moved[0], moved[2], s + moved[1])), np.stack((moved[0], moved[2] - r, moved[1]))

        t, r, s = _newton(stepped, np.stack((t, np.zeros_like(t), s)), (face, start, end - start, point, edge), steps)
        return t, r, s

    def meets(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Whether the ray at (u, v) really passes through `points` (3, n) at s > 0: that Newton's method arrived."""
        origin, ray = self.leave(face, uv)
        miss = norm(origin + s * ray - points)
        # without a viewing distance the mirror triangle's size stands in
        way = sum(map(norm, self.spans(face))) if self.unit_rays else norm(ray)
        return (s >= 0.0) & (miss <= ARRIVED * (norm(points - origin) + way))

    def turned(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray) -> np.ndarray:
        """How the map magnifies at distance s: the moved triangle's area across the ray over the area at s = 0.

        Its sign is the image's parity: it starts at +1 on the mirror and crosses zero on a caustic.
        """
        return self.turned_before(face, uv) * grown(self.linearise(face, uv, *ALONG_UV), s)


def _newton(stepped: Callable, found: np.ndarray, given: Sequence[np.ndarray], steps: int) -> np.ndarray:
    """Two shares and s (3, n) after so many steps, or as many as change more than rounding: `stepped` makes of what is
    found of some so far, and what is `given` for each, what is found next, and the step to it."""
    going = np.arange(found.shape[1])
    for _ in range(steps):
        now, step = stepped(found[:, going], *given)
        found[:, going] = now
        moving = np.maximum(np.abs(step[0]), np.abs(step[1])) > SETTLED
        more = np.flatnonzero(moving | (np.abs(step[2]) > SETTLED * np.abs(now[2])))
        if not len(more):
            break
        if len(more) < len(going):
            going, given = going[more], [part[..., more] for part in given]
    return found


def grown(seen: tuple, s: np.ndarray) -> np.ndarray:
    """`ReflectionMap.turned` by the last mirror alone, from what `ReflectionMap.linearise` tells along `ALONG_UV`."""
    _, ray, ((ou, ru), (ov, rv)) = seen
    before = dot(cross(ou, ov), ray)
    after = dot(cross(ou + s * ru, ov + s * rv), ray)
    return after / np.where(before != 0.0, before, 1.0)
