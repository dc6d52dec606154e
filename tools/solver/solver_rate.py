"""Rate of `core.project` on ordinary pairs beside that of the plain closed form, in one run.

    python -m tools.solver.solver_rate [--pairs 1000000] [--rounds 7]

All get the same pairs and return the same arrays. The plain ones take the textbook's closed form, sharpen its roots by
one step of Newton's, and keep what lies in the triangle: no bounds, no guards. The first is written in NumPy's own
products and indexing, on all pairs at once; the second on the component-first kernels and in the chunks of this
project, so that nothing but the solver is compared. Rounds alternate; ratios are medians of the rounds.
"""
from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from core import project
from core.geometry.vectors import columns, cross, dot
from core.solver.cubic import coefficients, differences
from core.solver.projection import CHUNK, Images
from tools.solver.textbook_cubic import closed_form_roots


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=1000000)
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args(arguments)
    print(f"{'pairs':20}{'images':>10}{'this, M/s':>12}{'plain':>8}{'ratio':>7}{'on our kernels':>16}{'ratio':>7}")
    for name, make in KINDS.items():
        pairs = make(np.random.default_rng(1), options.pairs)
        seconds = np.array([[_seconds(solve, pairs) for solve in (project, plain_project, kernel_project)]
                            for _ in range(options.rounds)])
        mine, plain, kernels = options.pairs / seconds.min(axis=0) / 1e6
        images = len(project(*pairs).pair)
        ratios = np.median(seconds[:, 1:] / seconds[:, :1], axis=0)
        print(f"{name:20}{images:10}{mine:12.2f}{plain:8.2f}{ratios[0]:7.2f}{kernels:16.2f}{ratios[1]:7.2f}")
    return 0


def plain_project(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> Images:
    """What `project` gives, by the closed form alone, in NumPy's own words."""
    p, a, b = vertices[:, 0] - points, vertices[:, 1] - vertices[:, 0], vertices[:, 2] - vertices[:, 0]
    r, u, v = rays[:, 0], rays[:, 1] - rays[:, 0], rays[:, 2] - rays[:, 0]
    n0, n1, n2 = np.cross(a, b), np.cross(a, v) + np.cross(u, b), np.cross(u, v)
    c = np.stack((_dot(p, n0), _dot(p, n1) + _dot(r, n0), _dot(p, n2) + _dot(r, n1), _dot(r, n2)))
    with np.errstate(all="ignore"):
        roots = closed_form_roots(c)[[1, 0, 2]].T     # in rising order
        pair, which = np.nonzero(roots > 0.0)
        s = roots[pair, which]
        c0, c1, c2, c3 = c[:, pair]
        s = s - (((c3 * s + c2) * s + c1) * s + c0) / ((3.0 * c3 * s + 2.0 * c2) * s + c1)
        slope = (3.0 * c3 * s + 2.0 * c2) * s + c1
        place, one, two = (still[pair] + s[:, None] * moving[pair] for still, moving in ((p, r), (a, u), (b, v)))
        normal = np.cross(one, two)
        square = _dot(normal, normal)
        second, third = _dot(np.cross(two, place), normal) / square, _dot(np.cross(place, one), normal) / square
        inside = (second >= 0.0) & (third >= 0.0) & (second + third <= 1.0)
    weights = np.stack((1.0 - second - third, second, third), axis=1)[inside]
    side = _dot(rays.sum(axis=1), n0)[pair]
    parity = np.where((side < 0.0) == (slope < 0.0), 1, -1).astype(np.int8)
    return Images(pair[inside], s[inside], weights, parity[inside], np.zeros(len(points), dtype=bool))


def _dot(a, b):
    return np.einsum("nk,nk->n", a, b)


def kernel_project(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> Images:
    """The same on this project's kernels, in its chunks."""
    found = []
    for start in range(0, len(points), CHUNK):
        part = slice(start, start + CHUNK)
        still, moving = differences(vertices[part], rays[part], points[part])
        c = coefficients(still, moving)
        with np.errstate(invalid="ignore", divide="ignore"):
            roots = closed_form_roots(c)[[1, 0, 2]]     # which is their rising order
            at = [np.flatnonzero(row > 0.0) for row in roots]
            s, pair = np.concatenate([row[k] for row, k in zip(roots, at)]), np.concatenate(at)
            c0, c1, c2, c3 = columns(c, pair)
            s -= (((c3 * s + c2) * s + c1) * s + c0) / ((3.0 * c3 * s + 2.0 * c2) * s + c1)
            place, velocity = (columns(part.reshape(9, -1), pair) for part in (still, moving))
            velocity *= s
            place += velocity
            p, a, b = place.reshape(3, 3, -1)
            normal = cross(a, b)
            square = dot(normal, normal)
            second, third = dot(cross(b, p), normal) / square, dot(cross(p, a), normal) / square
            weights = np.stack((1.0 - second - third, second, third), axis=1)
            inside = np.flatnonzero((second >= 0.0) & (third >= 0.0) & (second + third <= 1.0))
        slope = ((3.0 * c3 * s + 2.0 * c2) * s + c1)[inside]
        pair, s, weights = pair[inside], s[inside], weights[inside]
        side = dot(3.0 * moving[0] + moving[1] + moving[2], cross(still[1], still[2]))[pair]
        parity = np.where((side < 0.0) == (slope < 0.0), 1, -1).astype(np.int8)
        found.append((pair + start, s, weights, parity))
    pair, s, weights, parity = (np.concatenate(column) for column in zip(*found))
    order = np.argsort(pair, kind="stable")
    return Images(pair[order], s[order], weights[order], parity[order], np.zeros(len(points), dtype=bool))


def _anywhere(rng, n):
    """Random triangles, rays and points."""
    return (*rng.normal(size=(2, n, 3, 3)), rng.normal(size=(n, 3)))


def _seen(rng, n):
    """Random triangles and rays, and a point inside each camera."""
    vertices, rays = rng.normal(size=(2, n, 3, 3))
    weights, s = rng.dirichlet([1.0, 1.0, 1.0], n), rng.uniform(0.01, 3.0, n)
    return vertices, rays, np.einsum("nk,nkc->nc", weights, vertices + s[:, None, None] * rays)


def _ball(rng, n, size=0.05):
    """Cameras of a ball of small triangles seen from three diameters away, and points in and beside them."""
    middle = rng.normal(size=(n, 3))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    middle[:, 2] = np.abs(middle[:, 2])
    vertices = middle[:, None] + size * rng.normal(size=(n, 3, 3))
    vertices /= np.linalg.norm(vertices, axis=2, keepdims=True)
    d = vertices - [0.0, 0.0, 6.0]
    rays = d - 2.0 * (d * vertices).sum(axis=2, keepdims=True) * vertices
    weights = 1.6 * rng.dirichlet([0.7, 0.7, 0.7], n) - 0.2
    weights[:, 0] = 1.0 - weights[:, 1] - weights[:, 2]
    s = rng.uniform(0.05, 1.0, n)
    return vertices, rays, np.einsum("nk,nkc->nc", weights, vertices + s[:, None, None] * rays)


KINDS = {"anywhere": _anywhere, "one image at least": _seen, "a ball's cameras": _ball}


def _seconds(solve, pairs) -> float:
    started = time.perf_counter()
    solve(*pairs)
    return time.perf_counter() - started


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
