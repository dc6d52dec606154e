"""`core.project` held against the exact oracle: which disagreements there are, and whether rounding explains them.

With u = 2^-53 and P(t) = (|p| + t|r|) (|e1| + t|d1|) (|e2| + t|d2|), of which no coefficient of the cubic f exceeds its
own, the stated errors come to these, all from `core.solver.cubic` and `core.solver.projection`:

* A coefficient is off by 12 u of P's. One that this could hide counts as zero, then it is off by up to 24 u; Horner's
  rule adds 6 u: f is known to 30 u P. (Hence 18 u P where no coefficient is dropped.)
* A root is found to 2 * 30 u P / |f'| + 6 u t: the factor 2 for the curvature, the last with the roundings of 1 / t and
  of the unit.
* An extremum counts as a double root up to four times the bound of f there, on the computed cubic: 120 u P + 18 u P.
* Weights at a time are off by 8 u (|p| + t|r| + l1 + l2) / height, l the moved triangle's sides, and by the error of
  the time: the way that P and the triangle's sides move in it, over the height. A triangle whose height is less than
  that is a line as far as anyone can know. They are allowed up to 1/2, and clipped to 0 where negative.

A root is *clear* if none of these could merge it with another one or with 0 or infinity. A clear root that is an image
must be found, once; what is found must be one. The others form clusters, intervals in which |f| stays within
138 u P, its noise: an image in one must be found at some place in it, unless it holds 0 or infinity.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from core import Images, project
from tests.oracles.exact import to_float
from tests.oracles.exact_pairs import ExactPairs

UNIT = 2.0 ** -53
VALUE, DOUBLE, SLOPE, DEGENERATE = 30.0, 138.0, 48.0, 24.0
"""Units of P (of P' for the slope): what f is known to, what counts as a double root, as no slope; units of P's
coefficients: up to what all of f's may be called zero."""


@dataclass
class Verdict:
    """What there was, and the pairs of disagreements, by what they are.

    `images` exact images (weights >= 0), `clear` of them beyond doubt, `found` by `project`, `zero` pairs whose cubic
    is exactly zero. `errors` (k,) of the distances of clear images, in units of the condition times u, and those
    `conditions` (k,). `outside` (m,): how far images lie outside of edges though they are found, in units of how far
    they may. `explained` by rounding are

    * flagged: pairs called degenerate though not exactly zero,
    * line: an image is not found where the moved triangle is a line within rounding,
    * end: nor where it is within rounding of 0 or infinity,
    * edge: one is found on the outside of an edge,
    * touch: one of parity 0 is found where the cubic comes within its noise of zero without a root.
    """

    images: int = 0
    clear: int = 0
    found: int = 0
    zero: int = 0
    errors: np.ndarray = field(default_factory=lambda: np.zeros(0))
    conditions: np.ndarray = field(default_factory=lambda: np.zeros(0))
    outside: np.ndarray = field(default_factory=lambda: np.zeros(0))
    explained: dict[str, np.ndarray] = field(default_factory=dict)
    unexplained: dict[str, np.ndarray] = field(default_factory=dict)


class Looked:
    """Moments with the bounds that go with them."""

    multiplicity: np.ndarray  # of exact roots alone, as `sign`
    sign: np.ndarray

    def __init__(self, exact, pair, numerator, shift):
        self.pair, self.numerator, self.shift = pair, numerator, shift
        self.at = at = exact.at(pair, numerator, shift)
        x, e1, e2, r, d1, d2 = exact.lengths[:, pair]
        known = exact.unit[pair] * at.product
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            slope = np.abs(at.slope)
            self.error = 2.0 * VALUE * known / slope + 6.0 * UNIT * at.moved
            self.condition = at.product / (slope * at.moved)
            noise = 2.0 * DOUBLE * known
            self.clear = ((slope > 2.0 * SLOPE * exact.unit[pair] * at.product_slope)
                          & (slope ** 2 > 4.0 * noise * np.abs(at.bend))
                          & (slope ** 3 > 9.0 * noise ** 2 * np.abs(at.lead)) & (self.error < 0.25 * at.moved))
            # How far the roots of one cluster may lie apart, where there is no slope to tell (known to 18 u P').
            flat = np.fmin(np.sqrt(12.0 * DOUBLE * known / np.abs(2.0 * at.bend)),
                           np.cbrt(4.0 * DOUBLE * known / np.abs(at.lead)))
            sloping = slope > 12.0 * exact.unit[pair] * at.product_slope
            self.spread = np.where(self.clear, self.error, np.where(sloping, np.fmax(self.error, flat), flat))
            l1, l2 = (at.still * e + at.moved * d for e, d in ((e1, d1), (e2, d2)))
            self.still = 8.0 * UNIT * (at.still * x + at.moved * r + l1 + l2) / at.area
            self.moving = (r + d1 + d2) / at.area
            self.longest = l1 + l2
            self.sides = np.stack((l1 + l2, l2, l1), axis=1)
            self.sure = 2.0 * np.minimum(self.sides * (self.still + self.moving * self.spread)[:, None], 0.5)
            off = (self.still + self.moving * np.fmin(self.error, self.spread)) * self.longest
            self.solid = (at.area > 0.0) & (off < 0.25)
            # The root of a cubic within rounding of f, rounded itself; the double root of one.
            self.root = np.abs(at.value) <= VALUE * known + 6.0 * UNIT * at.moved * slope
            self.noise = np.abs(at.value) <= DOUBLE * known + 6.0 * UNIT * at.moved * slope
            self.weights = at.weights.min(axis=1)


def judge(vertices, rays, points, images=None, unit=UNIT) -> Verdict:
    """What `project` finds, or `images` that something else found, against the exact images. The `unit` roundoff of the
    arithmetic may be each pair's own."""
    exact = ExactPairs(vertices, rays, points)
    exact.unit[:] = unit
    if images is None:
        images = project(vertices, rays, points)
    verdict = Verdict()
    _judge_degenerate(exact, images, verdict)
    roots = exact.roots()
    root = Looked(exact, roots.cubic, roots.numerator, roots.shift)
    root.clear &= roots.multiplicity == 1
    root.multiplicity, root.sign = roots.multiplicity, roots.sign
    report = Looked(exact, images.pair, *exact.times(images.pair, images.distance))
    _judge_reports(report, images, verdict)
    verdict.images, verdict.found = int((root.weights >= 0.0).sum()), len(report.pair)
    taken = _judge_clear(exact, root, report, images, verdict)
    _judge_clusters(exact, root, report, images, taken, verdict)
    return verdict


def _judge_clear(exact, root: Looked, report: Looked, images: Images, verdict: Verdict) -> np.ndarray:
    """Clear roots and reports, one to one; which reports are taken by that."""
    image = (root.weights >= 0.0) & ~images.degenerate[root.pair]
    r, f = candidates(root.pair, report.pair, len(exact.facing))
    off = apart(root, r, report, f)
    near = root.clear[r] & (off * root.at.moved[r] <= root.error[r])
    r, f, off = r[near], f[near], off[near]
    times = np.bincount(r, minlength=len(root.pair))
    sure, lost = root.clear & root.solid, root.clear & image & (times == 0)
    outside = (-root.at.weights / root.sure).max(axis=1)
    _note(verdict.unexplained, "found twice", root.pair[times > 1])
    _note(verdict.unexplained, "missed", root.pair[sure & lost])
    _note(verdict.unexplained, "on a line", root.pair[root.clear & np.isnan(root.weights) & (times > 0)])
    _note(verdict.unexplained, "outside", root.pair[sure & (outside > 1.0) & (times > 0)])
    _note(verdict.explained, "line", root.pair[lost & ~root.solid])
    _note(verdict.explained, "edge", root.pair[root.clear & ~image & (times > 0)])
    side = np.sign(exact.facing) * (np.abs(exact.facing) > 16.0 * UNIT * exact.facing_size)
    parity = root.sign[r] * side[report.pair[f]]
    _note(verdict.unexplained, "parity", report.pair[f][(parity != 0) & (images.parity[f] != parity)])
    good = image[r] & root.solid[r]
    verdict.outside = outside[sure & ~image & (times > 0)]
    verdict.clear = int((sure & image).sum())
    verdict.conditions = np.maximum(root.condition[r], 1.0)[good]
    verdict.errors = off[good] / verdict.conditions / UNIT
    taken = np.zeros(len(report.pair), dtype=bool)
    taken[f] = True
    return taken


def _judge_clusters(exact, root: Looked, report: Looked, images: Images, taken: np.ndarray, verdict: Verdict
                    ) -> None:
    """What is left lies in clusters."""
    image, count = (root.weights >= 0.0) & ~images.degenerate[root.pair], len(exact.facing)
    single = images.parity != 0
    cloudy, loose = np.flatnonzero(~root.clear), np.flatnonzero(~taken)
    r, f = candidates(root.pair[cloudy], report.pair[loose], count)
    r, f = cloudy[r], loose[f]
    together = _one_cluster(exact, root, r, report, f)
    covered = np.bincount(r[together], minlength=len(root.pair)) > 0
    backed = np.bincount(f[together], minlength=len(report.pair)) > 0
    _note(verdict.explained, "touch", report.pair[loose[~backed[loose] & ~single[loose]]])
    _note(verdict.unexplained, "no root", report.pair[loose[~backed[loose] & single[loose]]])
    lost = cloudy[image[cloudy] & ~covered[cloudy]]
    _note(verdict.explained, "line", root.pair[lost[~root.solid[lost]]])
    lost = lost[root.solid[lost]]
    end = at_an_end(exact, root, lost)
    _note(verdict.explained, "end", root.pair[lost[end]])
    _note(verdict.unexplained, "missed in a cluster", root.pair[lost[~end]])
    there = np.bincount(root.pair[cloudy], weights=root.multiplicity[cloudy], minlength=count)
    _note(verdict.unexplained, "too many",
          np.flatnonzero(np.bincount(report.pair[loose[single[loose]]], minlength=count) > there))


def _note(where, what, pairs):
    if len(pairs):
        where[what] = np.concatenate((where.get(what, pairs[:0]), pairs))


def _judge_degenerate(exact, images, verdict):
    zero = (exact.cubic == 0).all(axis=0)
    small = (np.abs(exact.coefficients) <= DEGENERATE * exact.unit * exact.products).all(axis=0)
    verdict.zero = int(zero.sum())
    _note(verdict.explained, "flagged", np.flatnonzero(images.degenerate & ~zero))
    _note(verdict.unexplained, "zero, not flagged", np.flatnonzero(zero & ~images.degenerate))
    _note(verdict.unexplained, "flagged, not zero", np.flatnonzero(images.degenerate & ~small))
    _note(verdict.unexplained, "flagged, with images", images.pair[images.degenerate[images.pair]])


def _judge_reports(report, images, verdict):
    """Whatever is found is an image of a cubic within rounding of the true one, with the weights that it has there."""
    single = images.parity != 0
    _note(verdict.unexplained, "not a root", report.pair[~np.where(single, report.root, report.noise)])
    _note(verdict.unexplained, "on a line", report.pair[np.isnan(report.weights)])
    _note(verdict.unexplained, "parity 0 at a simple root", report.pair[~single & report.clear])
    # What is clipped from one weight goes to the others.
    bound = report.sure + report.sure.sum(axis=1, keepdims=True) + 4.0 * UNIT
    off = (np.abs(images.weights - report.at.weights) > bound) | (report.at.weights < -report.sure)
    _note(verdict.unexplained, "weights", report.pair[report.solid & off.any(axis=1)])


def candidates(roots, reports, count):
    """Every root and every report of the same pair."""
    per_pair = np.bincount(reports, minlength=count)
    first = np.cumsum(per_pair) - per_pair
    repeat = per_pair[roots]
    r = np.repeat(np.arange(len(roots)), repeat)
    return r, np.arange(len(r)) - np.repeat(np.cumsum(repeat) - repeat - first[roots], repeat)


def _common(root, r, report, f):
    """Numerators of both over the same power of two."""
    k, m = root.shift[r].astype(object), report.shift[f].astype(object)
    shift = np.maximum(k, m)
    return root.numerator[r] << shift - k, report.numerator[f] << shift - m, shift


def apart(root, r, report, f):
    """How far the report lies from the root, in units of the root."""
    x, y, _ = _common(root, r, report, f)
    return np.abs(to_float((y - x << 200) // x, -200))


def _noise(exact, pair, numerator, shift):
    at = exact.at(pair, numerator, shift)
    return np.abs(at.value) <= DOUBLE * exact.unit[pair] * at.product


def _one_cluster(exact, root, r, report, f):
    """Whether |f| is within its noise from the root to the report: a cubic that it is at five evenly spaced places
    stays within 2.3 times that between them."""
    x, y, shift = _common(root, r, report, f)
    return np.all([_noise(exact, root.pair[r], (4 - k) * x + k * y, shift + 2) for k in range(1, 5)], axis=0)


def at_an_end(exact, root, r):
    """The same from the root to 0, or by 1 / t to infinity."""
    pair, x, shift = root.pair[r], root.numerator[r], root.shift[r]
    outer = np.abs(exact.coefficients[:, pair]) <= DOUBLE * exact.unit[pair] * exact.products[:, pair]
    low = np.all([outer[0], *(_noise(exact, pair, k * x, shift + 2) for k in (1, 2, 3))], axis=0)
    return low | np.all([outer[3], *(_noise(exact, pair, 4 * x // k, shift) for k in (1, 2, 3))], axis=0)
