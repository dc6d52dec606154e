"""Base class of reflection maps, with Newton's method to find the image of a point or of a line.

A reflection map leads from a place (u, v) on a flat mirror triangle, where the eye sees it, to the ray that leaves the
last mirror: its origin O and direction R. After one reflection O is the place Q itself. The image of a point P is at
(u, v) if P = O(u, v) + s R(u, v) with s > 0.
"""
from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np

from ..geometry import cross, dot, norm, solve
from ..views import View
from .mirror_surface import ALONG_UV, MirrorSurface, Way

SETTLED = 1e-9  # share of a triangle's side, or of s: a shorter Newton step ends the iteration
DIFFERENCE = 1e-5  # share of a triangle's side: step of the difference quotients for bent rays
ARRIVED = 1e-10  # share of path plus viewing distance: largest distance at which a found ray counts as hitting a point


class ReflectionMap(ABC):
    """Rays at places (u, v) of a `face`: a triangle of the mirror, or after several bounces a chain of triangles.

    Attributes
    ----------
    view : View
    bounce : int, number of mirrors that the ray has hit: 1 for images in the mirror that the eye sees
    parallel : bool, True if all rays of a face have one direction; the map then jumps between faces
    orthographic : bool, True if rays are unit vectors and s is a length
    grazing : (m,) bool, True for faces on which some ray may be lifted
    """

    view: View
    bounce: int
    parallel: bool
    orthographic: bool
    grazing: np.ndarray

    @property
    def unit_rays(self) -> bool:
        """True if rays are unit vectors and s is a length; else rays are as long as the path from the eye."""
        return self.orthographic or self.parallel

    @abstractmethod
    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Return (u, v) as (2, n) of `places` (3, n) on the planes of the triangles that the eye sees."""

    @abstractmethod
    def places(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Return the places Q (3, n) on the mirror that the eye sees."""

    @abstractmethod
    def spans(self, face: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the derivatives (3, n) of Q with respect to u and to v."""

    @abstractmethod
    def first(self, face: np.ndarray) -> np.ndarray:
        """Return the indices (n,) of the mirror triangles that the eye sees."""

    @abstractmethod
    def last(self, face: np.ndarray) -> tuple[MirrorSurface, np.ndarray]:
        """Return the surface of the last mirror, and the indices (n,) of its triangles that the rays leave."""

    @abstractmethod
    def rays(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Return R (3, n), not normalised: as long as the whole path from the eye (1 in orthographic views)."""

    @abstractmethod
    def leave(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return O and R, (3, n) each."""

    @abstractmethod
    def met_later(self, face: np.ndarray, uv: np.ndarray) -> list[np.ndarray]:
        """Return a list of places (3, n), one for each mirror after the first; the last is O. Empty for one bounce."""

    @abstractmethod
    def leaving(self, face: np.ndarray, uv: np.ndarray, bent: bool = True) -> list[np.ndarray]:
        """Return a list of ray directions (3, n) after each mirror, the one nearest to the eye first; the last is R.

        If `bent` is False, each direction is the one before the ray is lifted at that mirror.
        """

    @abstractmethod
    def lifted(self, face: np.ndarray, uv: np.ndarray, slack: float = 0.0) -> np.ndarray:
        """Return True (n,) for rays that would enter a flat triangle and are lifted until they clear it.

        With `slack`, rays whose sine to the triangle is up to `slack` above the limit count too.
        """

    @abstractmethod
    def linearise(self, face: np.ndarray, uv: np.ndarray, *ways: Way) -> tuple:
        """Return O, R and a list of the derivatives (O', R') along each of the `ways` (2, n) in (u, v), all (3, n)."""

    @abstractmethod
    def turned_before(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray | float:
        """Return `turned` (n,) of the mirrors before the last one, at the last one; 1 after one bounce."""

    def _bend(self, part: np.ndarray, places: tuple[np.ndarray, np.ndarray], ways: tuple[Way, ...], rays: np.ndarray,
              changes: list[np.ndarray]) -> None:
        """Replace unbent rays and their derivatives by bent ones, in place; derivatives are difference quotients.

        Parameters
        ----------
        part : (m,) int64, indices of the rays to replace
        places : tuple, faces (n,) and (u, v) (2, n) of all rays
        ways : tuple, directions in (u, v) of the derivatives
        rays : (3, n) float64
        changes : list of (3, n) float64, derivatives of the rays along each way
        """
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
        """Solve O(u, v) + s R(u, v) = P by Newton's method from a near start.

        `points` (3, n) are P; `uv` (2, n) and `s` (n,) are the start. Return uv (2, n) and s (n,).
        """
        def stepped(now: np.ndarray, face: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            origin, ray, ((ou, ru), (ov, rv)) = self.linearise(face, now[:2], *ALONG_UV)
            s = now[2]
            step = solve(ou + s * ru, ov + s * rv, ray, points - origin - s * ray)
            # a step longer than the triangle means that the start is too far away: shorten it
            step /= np.maximum(1.0, np.maximum(np.abs(step[0]), np.abs(step[1])))
            return now + step, step

        found = _newton(stepped, np.concatenate((uv, s[None])), (face, points), steps)
        return found[:2], found[2]

    def meet(self, face: np.ndarray, line: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray],
             guess: tuple[np.ndarray, np.ndarray], steps: int = 5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Find by Newton's method the ray from a line on the mirror that hits another line in space.

        Parameters
        ----------
        face : (n,) int64
        line : tuple, start and end (2, n) in (u, v) of the line on the mirror
        other : tuple, P and E (3, n) of the line P + r E in space
        guess : tuple, t and s (n,) near the solution

        Returns
        -------
        t : (n,) float64, parameter along the mirror's line
        r : (n,) float64, parameter along the other line
        s : (n,) float64, parameter along the ray
        """
        (start, end), (point, edge), (t, s) = line, other, guess

        def stepped(now: np.ndarray, face: np.ndarray, start: np.ndarray, way: np.ndarray, point: np.ndarray,
                    edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            t, r, s = now
            origin, ray, ((move, change),) = self.linearise(face, start + t * way, way)
            moved = solve(move + s * change, ray, -edge, point - origin - s * ray)
            # s is a length in orthographic views: only t shows if a step is too long
            moved[:2] /= np.maximum(1.0, np.abs(moved[0]))
            return np.stack((t + moved[0], moved[2], s + moved[1])), np.stack((moved[0], moved[2] - r, moved[1]))

        t, r, s = _newton(stepped, np.stack((t, np.zeros_like(t), s)), (face, start, end - start, point, edge), steps)
        return t, r, s

    def meets(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return True (n,) if Newton's method converged: the ray at (u, v) passes through `points` (3, n) at s >= 0."""
        origin, ray = self.leave(face, uv)
        miss = norm(origin + s * ray - points)
        # without a viewing distance use the size of the mirror triangle
        way = sum(map(norm, self.spans(face))) if self.unit_rays else norm(ray)
        return (s >= 0.0) & (miss <= ARRIVED * (norm(points - origin) + way))

    def turned(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return the area growth (n,) of the ray bundle at distance `s` (n,), relative to its area at s = 0.

        The area is that of the moved triangle across the ray. The sign is the image's parity: it is +1 on the mirror
        and crosses zero on a caustic.
        """
        return self.turned_before(face, uv) * grown(self.linearise(face, uv, *ALONG_UV), s)


def _newton(stepped: Callable, found: np.ndarray, given: Sequence[np.ndarray], steps: int) -> np.ndarray:
    """Run Newton's method for n problems of three unknowns until all converge, or for `steps` steps.

    Parameters
    ----------
    stepped : callable
        Takes the current unknowns (3, k) and the `given` arrays of k problems; returns the next ones and the step.
    found : (3, n) float64, start values of two shares and s, changed in place and returned
    given : sequence of arrays with last axis n, constants of each problem
    steps : int
    """
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
    """Return `ReflectionMap.turned` (n,) of the last mirror alone.

    `seen` is the result of `ReflectionMap.linearise` along `ALONG_UV`; `s` (n,) is the distance.
    """
    _, ray, ((ou, ru), (ov, rv)) = seen
    before = dot(cross(ou, ov), ray)
    after = dot(cross(ou + s * ru, ov + s * rv), ray)
    return after / np.where(before != 0.0, before, 1.0)
