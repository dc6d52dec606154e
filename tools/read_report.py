"""Brings docs/benchmark.md up to a report of `make report`: its tables and the plots that it shows. What the page says
is written by hand: read it against the tables, and against the growth that this prints.

    python -m tools.read_report [report] [--page docs/benchmark.md]
"""
from __future__ import annotations

import argparse
import json
import re
import shutil
import sys
from pathlib import Path

COMPARED = {"refined, 0.5 px": ("GENERAL", 0.5), "refined, 0.25 px": ("GENERAL", 0.25), "rays, 1 x 1": ("RAYS", 1),
            "rays, 2 x 2": ("RAYS", 2), "2 x 2 at edges": ("RAYS_ADAPTIVE", 2),
            "4 x 4 at edges": ("RAYS_ADAPTIVE", 4), "BVHTree, 1 x 1": ("BVHTREE", 1), "BVHTree, 2 x 2": ("BVHTREE", 2)}
START, END = "<!-- {} by tools/read_report.py -->\n", "<!-- end of the table -->\n"


def main(arguments: list[str]) -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", nargs="?", type=Path, default=Path("report"), help="folder of the report")
    parser.add_argument("--page", type=Path, default=Path("docs/benchmark.md"))
    options = parser.parse_args(arguments)
    report = json.loads((options.report / "report.json").read_text(encoding="utf-8"))
    text = options.page.read_text(encoding="utf-8")
    for name, table in (("made", made(report)), ("seconds", seconds(report)), ("fronts", fronts(report))):
        before, rest = text.split(START.format(name))
        text = before + START.format(name) + table + END + rest.split(END, 1)[1]
    options.page.write_text(text, encoding="utf-8")
    plots = options.page.with_suffix("")
    plots.mkdir(parents=True, exist_ok=True)
    for name in sorted(set(re.findall(rf"\({plots.name}/(\w+\.svg)\)", text))):
        shutil.copyfile(options.report / "plots" / name, plots / name)
    for line in report["growths"]:
        points = ", ".join(f"{size:,}: {spent:.2f}" for size, spent in zip(line["sizes"], line["seconds"]))
        print(f"{line['title']}, {line['axis']}: {points}")
    return 0


def made(report: dict) -> str:
    """With what the report was made."""
    names = list(report["environment"])
    return (f"| {' | '.join(names)} |\n|{'---|' * len(names)}\n"
            f"| {' | '.join(str(report['environment'][name]) for name in names)} |\n")


def seconds(report: dict) -> str:
    """Seconds and mean error over the area of what is compared most."""
    lines = [f"| sample | {' | '.join(COMPARED)} |", f"|---|{'---|' * len(COMPARED)}"]
    for scene in report["scenes"]:
        runs = {(run["method"], run["value"]): run for run in scene["runs"]}
        cells = [f"{sum(run['seconds'].values()):.2f} s, {run['numbers']['area']['mean_error_px']:.3f}" if run else "–"
                 for run in map(runs.get, COMPARED.values())]
        lines.append(f"| {scene['name']} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def fronts(report: dict) -> str:
    """Tolerances of the general camera, refined, that are on the fronts."""
    lines = ["| sample | over the pixels' area | at the pixels' centres |", "|---|---|---|"]
    for scene in report["scenes"]:
        cells = [", ".join(f"{run['value']:g}" for run in scene["runs"]
                           if run["method"] == "GENERAL" and run["numbers"]["on_front"][measure]) or "none"
                 for measure in ("area", "centres")]
        lines.append(f"| {scene['name']} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
