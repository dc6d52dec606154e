"""The table and the plot of docs/numerics.md: this solver, textbook Cardano and numpy.roots against exact arithmetic.

    python -m tools.solver.numerics [--pairs 10000] [--page docs/numerics.md] [--plot docs/numerics.png]
"""
from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core import project
from tests.inputs.families import FAMILIES, pairs_of
from tests.oracles.exact_pairs import ExactPairs
from tests.oracles.explained import DEGENERATE, UNIT, Looked, apart, at_an_end, candidates
from tools.solver.textbook_cubic import closed_form_roots, companion_roots, project_by

START, END = "<!-- table by tools/solver/numerics.py -->\n", "<!-- end of the table -->\n"
COLOURS = {"this solver": "#0072B2", "textbook Cardano": "#E69F00", "numpy.roots": "#CC79A7"}
"""Okabe and Ito's, which stay apart to the colour-blind."""


@dataclass
class Score:
    """How one solver does on a family: true images missed, false ones, and of the clear ones condition and error."""

    missed: int
    false: int
    condition: np.ndarray
    error: np.ndarray


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=10000)
    parser.add_argument("--page", type=Path, default=Path("docs/numerics.md"))
    parser.add_argument("--plot", type=Path, default=Path("docs/numerics.png"))
    options = parser.parse_args(arguments)
    scores = {}
    for name in FAMILIES:
        scores[name] = measure(*pairs_of(name, options.pairs))
        print(f"{name}: done", file=sys.stderr, flush=True)
    page = options.page.read_text()
    if START not in page or END not in page:
        raise SystemExit(f"{options.page} lacks the lines between which the table belongs.")
    before, rest = page.split(START)
    options.page.write_text(before + START + table(scores) + END + rest.split(END)[1])
    draw({name: solvers for name, (_, solvers) in scores.items() if len(solvers["this solver"].error)}, options.plot)
    return 0


def measure(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> tuple[int, dict[str, Score]]:
    """Number of true images that float64 can decide, and each solver's score."""
    exact = ExactPairs(vertices, rays, points)
    roots = exact.roots()
    root = Looked(exact, roots.cubic, roots.numerator, roots.shift)
    root.clear &= roots.multiplicity == 1
    drowned = (np.abs(exact.coefficients) <= DEGENERATE * UNIT * exact.products).all(axis=0)
    decided = (root.weights >= 0.0) & root.solid & ~drowned[root.pair]
    cloudy = np.flatnonzero(decided & ~root.clear)
    decided[cloudy[at_an_end(exact, root, cloudy)]] = False
    images = project(vertices, rays, points)
    found = {"this solver": (images.pair, images.distance),
             "textbook Cardano": project_by(closed_form_roots, vertices, rays, points),
             "numpy.roots": project_by(companion_roots, vertices, rays, points)}
    return int(decided.sum()), {name: score(exact, root, decided, *given) for name, given in found.items()}


def score(exact: ExactPairs, root: Looked, decided: np.ndarray, pair: np.ndarray, distance: np.ndarray) -> Score:
    """An image is found where the distance is right to 1e-6, or as well as its condition allows; a false one is neither
    near a root nor within the noise of the cubic."""
    report = Looked(exact, pair, *exact.times(pair, distance))
    r, f = candidates(root.pair, pair, exact.cubic.shape[1])
    off = apart(root, r, report, f)
    with np.errstate(invalid="ignore"):
        near = off <= 1e-6 + np.where(root.clear, root.error, root.spread)[r] / root.at.moved[r]
    best = np.full(len(root.pair), np.inf)
    np.minimum.at(best, r[near], off[near])
    backed = np.bincount(f[near], minlength=len(pair)) > 0
    clear = decided & root.clear & np.isfinite(best)
    false = ~backed & ~report.noise
    return Score(int((decided & ~np.isfinite(best)).sum()), int(false.sum()), np.maximum(root.condition, 1.0)[clear],
                 best[clear])


def table(scores: dict[str, tuple[int, dict[str, Score]]]) -> str:
    solvers = list(COLOURS)
    lines = ["| family | true images | " + " | ".join(
        f"{what}: {solver}" for what in ("missed", "false") for solver in ("this", "Cardano", "numpy")) + " | "
        + " | ".join(f"error: {solver}" for solver in ("this", "Cardano", "numpy")) + " |",
        "|---|" + "---:|" * 10]
    total = np.zeros(7, dtype=int)
    for name, (images, by_solver) in scores.items():
        counts = [images, *(by_solver[s].missed for s in solvers), *(by_solver[s].false for s in solvers)]
        total += counts
        errors = []
        for solver in solvers:
            units = by_solver[solver].error / by_solver[solver].condition / UNIT
            errors.append(f"{np.median(units):.2g} / {_short(units.max())}" if len(units) else "")
        lines.append(f"| {name} | " + " | ".join(f"{count:,}" for count in counts) + " | " + " | ".join(errors) + " |")
    lines.append("| **all** | " + " | ".join(f"**{count:,}**" for count in total) + " | | | |")
    return "\n".join(lines) + "\n"


def _short(number: float) -> str:
    return f"{number:.1f}" if number < 1000 else f"{number:.0e}".replace("e+0", "e").replace("e+", "e")


def draw(scores: dict[str, dict[str, Score]], path: Path) -> None:
    """Error against condition, a panel for each family; what is missed stands in the band at the top."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    from PIL import Image
    columns = 5
    rows = -(-len(scores) // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(13.0, 2.1 * rows + 0.9), sharex=True, sharey=True)
    rng = np.random.default_rng(0)
    lowest, top = 1e-18, 1e-5
    for panel, (name, solvers) in zip(axes.flat, scores.items()):
        panel.set_title(name, fontsize=9)
        line = np.array([1.0, 1e16])
        panel.plot(line, 66.0 * UNIT * line, color="black", lw=0.8)
        panel.plot(line, UNIT * line, color="black", lw=0.8, ls=":")
        for solver in ("numpy.roots", "textbook Cardano", "this solver"):
            score = solvers[solver]
            some = rng.permutation(len(score.error))[:400]
            # the worst ones too, which a sample would hide
            some = np.union1d(some, np.argsort(score.error / score.condition)[-20:]) if len(some) else some
            panel.scatter(score.condition[some], np.maximum(score.error[some], lowest), s=3, lw=0, alpha=0.6,
                          color=COLOURS[solver], rasterized=True)
        missed = [f"{solvers[solver].missed:,}" for solver in COLOURS]
        for place, (solver, count) in zip((0.03, 0.36, 0.69), zip(COLOURS, missed)):
            panel.text(place, 0.97, count, color=COLOURS[solver], transform=panel.transAxes, va="top", fontsize=8,
                       fontweight="bold", bbox={"color": "white", "pad": 0.5})
        panel.set(xscale="log", yscale="log", xlim=(0.7, 1e14), ylim=(lowest / 2.0, top * 100.0))
        panel.grid(True, lw=0.3)
    for panel in axes.flat[len(scores):]:
        panel.axis("off")
    handles = [pyplot.Line2D([], [], marker="o", ls="", color=colour, label=solver)
               for solver, colour in COLOURS.items()]
    handles += [pyplot.Line2D([], [], color="black", lw=0.8, label="stated bound: 66 condition × u"),
                pyplot.Line2D([], [], color="black", lw=0.8, ls=":", label="condition × u")]
    figure.legend(handles=handles, loc="upper center", ncol=5, frameon=False, fontsize=10)
    figure.supxlabel("condition number of the distance")
    figure.supylabel("relative error of the distance (numbers at the top: true images missed)")
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 1.0 - 0.35 / figure.get_figheight()))
    figure.savefig(path, dpi=80)
    with Image.open(path) as picture:                    # few colours: a third of the size
        picture.convert("RGB").quantize(64).save(path, optimize=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
