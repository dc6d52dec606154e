"""The tables of docs/benchmark.md from a report of `make report`, and its plots.

    python benchmarks/read_report.py [report] [--plots docs/benchmark]
"""
from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

COMPARED = (("GENERAL", 0.5), ("GENERAL", 0.25), ("RAYS", 1), ("RAYS_ADAPTIVE", 2), ("RAYS", 2), ("RAYS_ADAPTIVE", 4),
            ("RAYS", 4), ("BVHTREE", 1), ("BVHTREE", 2))
PLOTS = ("*_area_mean_error_px.svg", "growth_*.svg", "sphere_mean_error_px.svg", "sphere_stages.svg",
         "suzanne_stages.svg")


def main(arguments: list[str]) -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", nargs="?", type=Path, default=Path("report"), help="folder of the report")
    parser.add_argument("--plots", type=Path, help="copy the page's plots here")
    options = parser.parse_args(arguments)
    report = json.loads((options.report / "report.json").read_text(encoding="utf-8"))
    print(f"{report['environment']}\n")
    _fronts(report)
    _seconds(report)
    for line in report["growths"]:
        points = ", ".join(f"{size:,}: {seconds:.2f}" for size, seconds in zip(line["sizes"], line["seconds"]))
        print(f"{line['title']}, {line['axis']}: {points}")
    if options.plots:
        options.plots.mkdir(parents=True, exist_ok=True)
        for path in [path for pattern in PLOTS for path in (options.report / "plots").glob(pattern)]:
            shutil.copyfile(path, options.plots / path.name)
    return 0


def _fronts(report: dict) -> None:
    """Which settings are on the front, by measure."""
    print("| sample | on the front over the area | on the front at the centres |\n|---|---|---|")
    for scene in report["scenes"]:
        cells = []
        for measure in ("area", "centres"):
            found: dict = {}
            for run in scene["runs"]:
                if run["numbers"]["on_front"][measure]:
                    found.setdefault(run["method"], []).append(f"{run['value']:g}")
            cells.append("; ".join(f"{method} {', '.join(values)}" for method, values in found.items()))
        print(f"| {scene['name']} | {' | '.join(cells)} |")
    print()


def _seconds(report: dict) -> None:
    """Seconds and mean error over the area of what is compared most."""
    heads = " | ".join(f"{method} {value:g}" for method, value in COMPARED)
    print(f"| sample | {heads} |\n|---|{'---|' * len(COMPARED)}")
    for scene in report["scenes"]:
        runs = {(run["method"], run["value"]): run for run in scene["runs"]}
        cells = []
        for key in COMPARED:
            run = runs.get(key)
            cells.append(f"{sum(run['seconds'].values()):.2f} s, {run['numbers']['area']['mean_error_px']:.3f} px"
                         if run else "–")
        print(f"| {scene['name']} | {' | '.join(cells)} |")
    print()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
