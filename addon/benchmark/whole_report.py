"""The report of a benchmark as a folder: page, numbers, pictures and plots."""
from __future__ import annotations

import json
import os
import platform
import time

import bpy
import numpy as np

from ..report import Report, Scene, csv_text, document, page, plot_files, run_rows
from .answer import NOTES
from .growth import growths
from .options import Options
from .talk import costs


def write_benchmark(folder: str, scenes: list[Scene], options: Options,
                    since: tuple[float, float] | None = None) -> Report:
    """Write report.html, report.json, report.csv and plots/*.svg.

    Parameters
    ----------
    folder : str
        An existing folder.
    since : (float, float), optional
        `time.perf_counter()` and `time.process_time()` when the benchmark began.
    """
    lines, left_out = growths(options.growth, options.tell) if options.growth else ([], [])
    counted, setting = costs() if options.work else ([], "")
    environment = {"Blender": bpy.app.version_string, "NumPy": np.__version__, "Python": platform.python_version(),
                   "processors": os.cpu_count()}
    if since is not None:
        environment["made in"] = (f"{time.perf_counter() - since[0]:.0f} s, {time.process_time() - since[1]:.0f} s of "
                                  "processor time")
    title = ("Speed against error: every method on every scene" if len(scenes) > 1 else
             f"Speed against error: {scenes[0].name}")
    report = Report(title, tuple(scenes), tuple(lines), tuple(counted), setting, environment, NOTES, tuple(left_out))
    texts = {"report.json": json.dumps(document(report), indent=1) + "\n", "report.csv": csv_text(run_rows(report)),
             "report.html": page(report)}
    plots = plot_files(report)
    os.makedirs(os.path.join(folder, "plots"), exist_ok=True)
    for name, text in (*texts.items(), *((os.path.join("plots", name), text) for name, text in plots.items())):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    return report
