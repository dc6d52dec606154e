"""The textbook's ways to a point's images in a three-ray camera, unguarded, to compare `core.project` with."""
from __future__ import annotations

import numpy as np

from core.geometry.vectors import cross, dot


def closed_form_roots(coefficients: np.ndarray) -> np.ndarray:
    """Real roots (3, n) of c0 + c1 s + c2 s^2 + c3 s^3 (4, n), in no order, nan where there are fewer.

    Cardano's formula where one root is real and Viete's trigonometric one where three are (W. H. Press et al.,
    "Numerical Recipes", 3rd ed., section 5.6, where it reads without a guard for c3 = 0 too).
    """
    c0, c1, c2, c3 = coefficients
    roots = np.full((3, len(c0)), np.nan)
    with np.errstate(all="ignore"):
        inverse = 1.0 / c3
        a, b = c2 * inverse, c1 * inverse
        third = a * (1.0 / 3.0)
        q = third * third - b * (1.0 / 3.0)
        r = 0.5 * (third * (2.0 * third * third - b) + c0 * inverse)
        discriminant = r * r - q * q * q
        real = np.flatnonzero(discriminant < 0.0)
        if len(real):
            size = np.sqrt(q[real])
            angle = np.arccos(r[real] / (size * q[real])) * (1.0 / 3.0)
            size *= -2.0
            for k in range(3):
                roots[k, real] = size * np.cos(angle + (2.0 * np.pi / 3.0) * (k - 1)) - third[real]
        one = np.flatnonzero(discriminant >= 0.0)
        if len(one):
            r = r[one]
            u = -np.copysign(np.cbrt(np.abs(r) + np.sqrt(discriminant[one])), r)
            roots[0, one] = u + np.where(u == 0.0, 0.0, q[one] / u) - third[one]
    return roots


def companion_roots(coefficients: np.ndarray) -> np.ndarray:
    """The same by `numpy.roots`, one cubic after the other; complex ones are nan."""
    roots = np.full((3, coefficients.shape[1]), np.nan)
    for k, column in enumerate(coefficients[::-1].T):
        found = np.roots(column)
        roots[:len(found), k] = np.where(found.imag == 0.0, found.real, np.nan)
    return roots


def cubics(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray):
    """Coefficients (4, n), places and velocities (3, 3, n) of A - P, B - A, C - A, and the unit of time (n,).

    As in `core.projection`: relative to the point, in powers of two that bring places and velocities near 1, so that
    nothing but the root finder is compared.
    """
    still, moving = (np.moveaxis(given, 0, 2).copy() for given in (vertices, rays))
    still[1:] -= still[0]
    still[0] -= points.T
    moving[1:] -= moving[0]
    units = [2.0 ** np.floor(np.log2(np.where(size > 0.0, size, 1.0)))
             for size in (np.abs(part).max(axis=(0, 1)) for part in (still, moving))]
    still, moving = still / units[0], moving / units[1]
    (p, a, b), (r, u, v) = still, moving
    n0, n1, n2 = cross(a, b), cross(a, v) + cross(u, b), cross(u, v)
    coefficients = np.stack((dot(p, n0), dot(p, n1) + dot(r, n0), dot(p, n2) + dot(r, n1), dot(r, n2)))
    return coefficients, still, moving, units[0] / units[1]


def project_by(roots_of, vertices: np.ndarray, rays: np.ndarray, points: np.ndarray):
    """pair (m,) and distance (m,) of what a root finder takes for images: s > 0, weights >= -1e-9."""
    coefficients, still, moving, seconds = cubics(vertices, rays, points)
    roots = roots_of(coefficients)
    with np.errstate(all="ignore"):
        pair, which = np.nonzero(((roots > 0.0) & np.isfinite(roots)).T)
        t = roots[which, pair]
        p, a, b = still[..., pair] + t * moving[..., pair]
        normal = cross(a, b)
        square = dot(normal, normal)
        second, third = dot(cross(b, p), normal) / square, dot(cross(p, a), normal) / square
        inside = (second >= -1e-9) & (third >= -1e-9) & (second + third <= 1.0 + 1e-9)
    return pair[inside], (t * seconds[pair])[inside]
