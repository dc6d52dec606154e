"""Images of points on a patch: Newton's method on the true map, with a walk over the mirror's triangles.

An image is a root of Q(u, v) + s R(u, v) = P. On a patch there is at most one, so any start that converges is good.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..cameras import least_weight
from ..geometry import columns, cross, dot
from ..support import portions
from .patch import Patch

AT_ONCE = 8192  # points per chunk, whose arrays fit the CPU cache
STEPS, LOOKS = 2, 40  # Newton steps per round, after which the triangle is checked; largest number of rounds
NEAR_LOOKS = 6  # largest number of rounds, of one step each, from a near start
FEW = 4  # rounds after which most points have converged
ARRIVED = 1e-7  # length of a step in (u, v), below which the point has converged: the next step is rounding
NEARLY = 1e-5  # the same from near starts, where the error is about the square of the last step
LONGEST = 1.5  # longest step, in (u, v)
FUTILE = 8.0  # ratio that means divergence: distance over the border to last step, or last step to a round's motion
INSIDE = 1e-6  # barycentric tolerance for rounding: points this little outside of a triangle count as inside


def find(patch: Patch, member: np.ndarray, uv: np.ndarray, s: np.ndarray,
         points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Find the images of points on a patch by Newton's method.

    Parameters
    ----------
    member, uv, s : (n,) int64, (2, n) float64, (n,) float64, start: triangle of the patch, place on it, distance
    points : (3, n) float64, relative to the eye

    Returns
    -------
    member, uv, s : the same for the images
    found : (n,) bool, True for points with an image
    """
    return _found(_Walk.of(patch, member, uv, s, points), LOOKS)


def find_near(patch: Patch, member: np.ndarray, uv: np.ndarray, s: np.ndarray,
              points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Find images like `find`, from starts that are mostly so near that one step is enough."""
    return _found(replace(_Walk.of(patch, member, uv, s, points), steps=1, arrived=NEARLY), NEAR_LOOKS)


def _found(walk: _Walk, looks: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    left = walk.walked(np.arange(len(walk.member)), FEW)
    # a few points need many more rounds: continue with those of all chunks together
    walk.walked(left, looks - FEW)
    return walk.member, walk.uv, walk.s, walk.found


@dataclass(frozen=True)
class _Walk:
    """State of Newton's method for n points.

    Each round makes `steps` steps. `before` (n,) are the triangles that the points came from, -1 for none. A step
    shorter than `arrived` is the last one.
    """

    patch: Patch
    member: np.ndarray
    uv: np.ndarray
    s: np.ndarray
    points: np.ndarray
    before: np.ndarray
    found: np.ndarray
    steps: int = STEPS
    arrived: float = ARRIVED

    @classmethod
    def of(cls, patch: Patch, member, uv, s, points) -> _Walk:
        count = len(member)
        return cls(patch, member.copy(), uv.copy(), s.copy(), points, np.full(count, -1), np.zeros(count, dtype=bool))

    def walked(self, active: np.ndarray, looks: int) -> np.ndarray:
        """Run up to `looks` rounds for the points `active`, and return the indices of those not finished."""
        left = [active[:0]]
        for part in portions(len(active), AT_ONCE):
            left.append(active[part])
            for _ in range(looks):
                if not len(left[-1]):
                    break
                left[-1] = self._look(left[-1])
        return np.concatenate(left)

    def _look(self, active: np.ndarray) -> np.ndarray:
        patch, member, uv, before = self.patch, self.member, self.uv, self.before
        start = columns(uv, active)
        on, far, moved = newton(patch, member[active], start, self.s[active], columns(self.points, active), self.steps)
        uv[:, active], self.s[active] = on, far
        inside = least_weight(on) >= -INSIDE
        done = inside & (moved < self.arrived)
        self.found[active[done]] = far[done] > 0.0
        rest = np.flatnonzero(~done)
        active, moved, inside = active[rest], moved[rest], inside[rest]
        u, v = columns(on, rest)
        weights = np.stack((1.0 - u - v, u, v))
        lowest = weights.argmin(axis=0)
        beyond = patch.across[member[active], lowest]
        # a point that goes back to its last triangle, or over the border, has not converged yet, or has no image
        back = ~inside & ((beyond == before[active]) | (beyond < 0))
        before[active[back]] = -1
        walking = ~inside & ~back
        went = np.abs(columns(on - start, rest)).max(axis=0)
        nowhere = (beyond < 0) & (FUTILE * moved < -weights[lowest, np.arange(len(rest))])
        nowhere |= np.minimum(moved, LONGEST) > FUTILE * went
        i = active[walking]
        if len(i):
            drawn = np.maximum(weights[:, walking], 0.0)
            place = patch.places(member[i], drawn[1:] / drawn.sum(axis=0))
            before[i], member[i] = member[i], beyond[walking]
            uv[:, i] = patch.coordinates(member[i], place)
        return active[walking | (moved >= self.arrived) & ~nowhere]


def newton(patch: Patch, member, uv, s, points, steps: int = STEPS) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Make `steps` Newton steps towards the images of points P: solve Q(u, v) + s R(u, v) = P for u, v and s.

    Q is the place (u, v) in the plane of a mirror triangle, inside or outside of the triangle. R is the reflected ray
    there. It is as long as the distance from the eye to Q, or 1 in an orthographic view.

    Parameters
    ----------
    member : (n,) int64, triangles of the patch, which the steps do not change
    uv, s : (2, n) and (n,) float64, start
    points : (3, n) float64, P relative to `patch.eye`

    Returns
    -------
    uv, s : (2, n) and (n,) float64, after the steps
    moved : (n,) float64
        Length of the last step: the larger one of the changes of u and v, before it is limited to `LONGEST`.
    """
    shape = columns(patch.shape, member).reshape(6, 3, -1)
    for _ in range(steps):
        place, c0, c1, ray = _moved(patch, shape, uv, s)
        right = np.subtract(points, place, out=place)
        right -= s * ray
        step = _solved(c0, c1, ray, right)
        moved = np.maximum(np.abs(step[0]), np.abs(step[1]))
        step /= np.maximum(1.0, moved / LONGEST)
        uv, s = uv + step[:2], s + step[2]
    return uv, s, moved


def _moved(patch: Patch, shape, uv, s) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the places Q, the derivatives of Q + s R with respect to u and to v, and the rays R, all (3, n)."""
    a, u, v, n0, nu, nv = shape
    place, n = uv[0] * u, uv[0] * nu
    place += a
    place += uv[1] * v
    n += n0
    n += uv[1] * nv
    arriving, orthographic = patch.arriving(place), patch.mirror_map.orthographic
    twice = 2.0 / dot(n, n)
    slope = dot(arriving, n) * twice
    farther, sides = s * slope, []
    twice *= s
    for along, turn in ((u, nu), (v, nv)):
        # R = d - slope n; the direction d changes with the place, except in orthographic views
        change = dot(arriving, turn) - slope * dot(n, turn)
        side = along * (1.0 if orthographic else 1.0 + s)
        if not orthographic:
            change += dot(along, n)
        change *= twice
        side -= change * n
        side -= farther * turn
        sides.append(side)
    return place, sides[0], sides[1], arriving - slope * n


def _solved(c0, c1, ray, right) -> np.ndarray:
    """Solve u c0 + v c1 + s R = right for u, v, s (3, n)."""
    normal, turned = cross(c1, ray), cross(c0, right)
    determinant = dot(c0, normal)
    found = np.stack((dot(right, normal), dot(turned, ray), -dot(turned, c1)))
    found /= np.where(np.abs(determinant) > 1e-300, determinant, 1e-300)
    return found


def changes(patch: Patch, member, uv, s) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivatives of images with respect to their points.

    Returns
    -------
    inverse : (3, 3, n) float64, gradients of u, v and s, as [u v or s, component, image]
    pixels : (2, 3, n) float64, gradients of the picture position in pixels, as [x or y, component, image]
    """
    shape = columns(patch.shape, member).reshape(6, 3, -1)
    place, *moved = _moved(patch, shape, uv, s)
    inverse = _inverse(*moved)
    return np.stack(inverse), np.stack([dot(gradient, shape[1]) * inverse[0] + dot(gradient, shape[2]) * inverse[1]
                                        for gradient in patch.view.pixel_gradients(place + patch.eye)])


def _inverse(c0, c1, ray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the rows (3, n) of the inverse of matrices with the columns c0, c1 and R."""
    normal = cross(c1, ray)
    determinant = dot(c0, normal)
    inverse = 1.0 / np.where(np.abs(determinant) > 1e-300, determinant, 1e-300)
    return normal * inverse, cross(ray, c0) * inverse, cross(c0, c1) * inverse
