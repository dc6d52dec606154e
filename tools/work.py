"""Work instead of seconds: what each method counts on the setting of the talk's cost model, beside its predictions.

    python -m tools.work [--resolution 1024] [method ...]

The talk sets 1M pixels, all of which show the mirror, 1K diffuse vertices with 2K triangles and 1K mirror vertices with
2K triangles, and predicts: ray tracing 2M Ti + 1M Tt, reflection morphing 1M Ti + 1K Tt, ray tracing with clustering
2M Ti + 2K Tt, its own method 2K Tp + 2K Tt; Ti is the test of a ray against a triangle, Tt a traversal of a tree, Tp
the projection of a vertex. Prints a table in Markdown.
"""
from __future__ import annotations

import argparse
import sys
from functools import partial

from core.rivals import METHODS, primary_hits
from core.rivals.morphing import morphed
from core.rivals.scenes import talk_setting
from tests.oracles.judge import compare_picture
from tests.oracles.truth import trace

COLUMNS = ("method", "knob", "Ti", "Tt", "Tp", "rays", "nodes", "predicted", "median px", "p99 px", "uncovered %",
           "seconds")
PREDICTED = {"RAYS": "2M Ti + 1M Tt", "MORPHING": "1M Ti + 1K Tt", "CLUSTERS": "2M Ti + 2K Tt",
             "UNREFINED": "2K Tp + 2K Tt"}
KNOBS = {"RAYS": 1, "CLUSTERS": 0, "ENVIRONMENT": 256, "ENVIRONMENT_BOX": 256, "MORPHING": 16000, "BILLBOARDS": 256,
         "POINTS": 30_000, "PARALLEL": 0, "UNREFINED": 0, "GENERAL": 0.5}
OWN = 1000  # vertices: no more than the scene has


def runs(names: list[str]) -> list[tuple]:
    """(title, knob, prediction, run) of each line of the table."""
    lines: list[tuple] = []
    for name in names:
        rival = METHODS[name]
        if name == "MORPHING":
            lines.append((rival.title + ", as in the talk", 10**6, PREDICTED[name], partial(morphed, rounds=0)))
        if name == "POINTS":
            lines.append(("Points, the scene's own vertices", OWN, PREDICTED["UNREFINED"], rival.run))
        predicted = "" if name == "MORPHING" else PREDICTED.get(name, "")
        lines.append((rival.title, KNOBS[name], predicted, rival.run))
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("methods", nargs="*", metavar="method", help=f"all where none is named: {', '.join(METHODS)}")
    parser.add_argument("--resolution", type=int, default=1024, help="pixels of width and height (1024)")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.methods if name not in METHODS]
    if unknown:
        parser.error(f"there is no method {', '.join(unknown)}; choose from {', '.join(METHODS)}")
    case = talk_setting((options.resolution, options.resolution))
    truth = trace(case.view, case.mirror, case.scene)
    hits = primary_hits(case.view, case.mirror, case.scene)
    print(f"{len(hits.pixel):,} pixels show the mirror; {len(case.mirror.positions):,} vertices and "
          f"{len(case.mirror.triangles):,} triangles of the mirror, {len(case.scene.positions):,} and "
          f"{len(case.scene.triangles):,} of the scene\n")
    print("| " + " | ".join(COLUMNS) + " |\n|---" + "|---:" * (len(COLUMNS) - 1) + "|")
    _line("What the eye sees of the mirror", "", hits.counts, "", None, hits.seconds)
    for title, knob, predicted, run in runs(options.methods or list(METHODS)):
        picture = run(case.view, case.mirror, case.scene, knob, hits)
        numbers = compare_picture(case.view, truth, picture.triangle, picture.position).numbers
        _line(title, knob, picture.counts, predicted, numbers, picture.seconds)
    return 0


def _line(title, knob, counts, predicted, numbers, seconds) -> None:
    work = [f"{counts[name]:,}" for name in ("intersections", "traversals", "projections", "rays", "nodes")]
    errors = ["", "", ""] if numbers is None else [f"{numbers[k]:.3f}" for k in ("median", "p99", "uncovered")]
    print("| " + " | ".join((title, str(knob), *work, predicted, *errors, f"{sum(seconds.values()):.2f}")) + " |",
          flush=True)


if __name__ == "__main__":
    sys.exit(main())
