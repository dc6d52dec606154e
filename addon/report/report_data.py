"""Contents of a report as plain data: runs of methods on scenes, growth with size, counts of work, pictures."""
from __future__ import annotations

import csv
import io
import time
from collections.abc import Generator
from dataclasses import asdict, dataclass, field

import numpy as np

LEAST = 1e-3    # pixels: mean errors below are no better than this to anyone, and may be rounding


@dataclass(frozen=True)
class Run:
    """One method at one setting of its knob, on one scene.

    Attributes
    ----------
    method, title : str
        Its key, and its name for readers.
    knob, value : str, float or None
        What was turned and how far; an empty name and None where there is nothing to turn.
    seconds, counts : dict
        Seconds by stage, in order, and work by kind.
    numbers : dict
        Errors, nested as in report.json: `displacement_px`, `coverage_percent`, `picture`.
    """

    method: str
    title: str
    knob: str
    value: float | None
    seconds: dict
    counts: dict
    numbers: dict

    @property
    def total(self) -> float:
        """Seconds of all stages."""
        return float(sum(self.seconds.values()))

    @property
    def label(self) -> str:
        """Name and setting."""
        return f"{self.title}, {self.knob} {self.value:g}" if self.knob and self.value is not None else self.title


@dataclass(frozen=True)
class Growth:
    """Seconds of a method over the size of its input; `axis` says what grows, as "diffuse vertices"."""

    method: str
    title: str
    axis: str
    sizes: tuple
    seconds: tuple


@dataclass(frozen=True)
class Cost:
    """Work of a method in a fixed setting beside what was predicted, both by kind, and why they differ."""

    method: str
    title: str
    measured: dict
    predicted: dict
    explanation: str


@dataclass(frozen=True)
class Picture:
    """An image file to show: `data` are its bytes, `kind` its MIME type."""

    name: str
    title: str
    caption: str
    data: bytes = field(repr=False)
    kind: str = "image/png"


@dataclass(frozen=True)
class Scene:
    """One scene: an answer in `summary` (sentences), facts by label, pictures, and the runs of all methods on it.

    `pictures` are shown in order, the first two large and side by side. `skipped` says what was left out, and
    `references` are (label, seconds) to compare times with.
    """

    name: str
    summary: tuple = ()
    facts: dict = field(default_factory=dict)
    pictures: tuple = ()
    runs: tuple = ()
    skipped: tuple = ()
    references: tuple = ()


@dataclass(frozen=True)
class Report:
    """Everything that one report tells; `left_out` says which sizes the growth does not reach."""

    title: str
    scenes: tuple
    growths: tuple = ()
    costs: tuple = ()
    cost_setting: str = ""
    environment: dict = field(default_factory=dict)
    notes: tuple = ()
    left_out: tuple = ()


def timed(steps: Generator) -> tuple[object, dict]:
    """Run a generator that yields (fraction, stage) to its end; returns what it returns, and seconds by stage.

    A stage is told before its work is done; what comes before the first is called "start", if it takes any time.
    """
    seconds: dict = {}
    stage, since = "start", time.perf_counter()
    while True:
        try:
            _, told = next(steps)
            result, ended = None, False
        except StopIteration as stop:
            told, result, ended = "", stop.value, True
        now = time.perf_counter()
        if now > since:
            seconds[stage] = seconds.get(stage, 0.0) + now - since
        if ended:
            return result, seconds
        stage, since = told, now


def number(values: dict, path: str) -> float | None:
    """A nested value by its dotted path, as "displacement_px.p99"; None where there is none."""
    for name in path.split("."):
        if not isinstance(values, dict):
            return None
        values = values.get(name)
    return None if values is None else float(values)


def pareto(costs: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return True (n,) for points on the Pareto front of `costs` (n,) and `errors` (n,), where less is better.

    A point is on the front if no other point is at least as good in both and better in one.
    """
    costs, errors = np.asarray(costs, dtype=np.float64), np.asarray(errors, dtype=np.float64)
    no_worse = (costs[:, None] <= costs) & (errors[:, None] <= errors)
    better = (costs[:, None] < costs) | (errors[:, None] < errors)
    return ~(no_worse & better).any(axis=0)


def flat(values: dict, prefix: str = "") -> dict:
    """Nested values as one row: {"a": {"b": 1}} -> {"a.b": 1}; lists are joined by spaces."""
    row = {}
    for name, value in values.items():
        if isinstance(value, dict):
            row.update(flat(value, f"{prefix}{name}."))
        else:
            row[prefix + name] = " ".join(map(str, value)) if isinstance(value, (list, tuple)) else value
    return row


def csv_text(rows: list[dict]) -> str:
    """Rows of any columns as comma-separated text with a header; what a row lacks is left empty."""
    columns = list(dict.fromkeys(name for row in rows for name in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def run_rows(report: Report) -> list[dict]:
    """A row for each run of each scene, for report.csv."""
    return [{"scene": scene.name, "method": run.method, "knob": run.knob, "value": run.value,
             "seconds.total": run.total, **flat(run.seconds, "seconds."), **flat(run.counts, "count."),
             **flat(run.numbers)} for scene in report.scenes for run in scene.runs]


def document(report: Report) -> dict:
    """The report for report.json: everything but the pictures' bytes."""
    content = asdict(report)
    for scene in content["scenes"]:
        for picture in scene["pictures"]:
            del picture["data"]
    return content
