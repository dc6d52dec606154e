"""The plots of a report: which numbers against which, and what each shows."""
from __future__ import annotations

from html import escape

from .report_data import Growth, Report, Scene, number
from .svg_axes import short
from .svg_plots import Series, bar_plot, line_plot

# errors that are plotted: their path and their axis
ERRORS = (("displacement_px.p99", "displacement, 99th percentile (px)"),
          ("picture.mirror.flip", "FLIP (0 equal, 1 worst)"))


def styles_of(report: Report) -> dict:
    """A number for each method, by which it has the same colour and marker in all plots."""
    methods = [run.method for scene in report.scenes for run in scene.runs] + [line.method for line in report.growths]
    return {method: index for index, method in enumerate(dict.fromkeys(methods))}


def scene_plots(scene: Scene, styles: dict) -> str:
    """Errors against seconds and against work, and time by stage."""
    parts = []
    for path, label in ERRORS:
        parts.append(_figure(_plot(scene, styles, path, label, "time to the reflection (s)", lambda run: run.total),
                             f"Error against time, both logarithmic: {label}. Lines join the settings of one method."))
    for kind in dict.fromkeys(kind for run in scene.runs for kind in run.counts):
        path, label = ERRORS[0]
        plot = _plot(scene, styles, path, label, f"{kind} (count)", lambda run, kind=kind: run.counts.get(kind))
        parts.append(_figure(plot, f"Error against counted work: {kind}. Methods that do none of it are left out."))
    bars = [(run.label, run.seconds) for run in scene.runs if run.total > 0.0]
    parts.append(_figure(bar_plot(bars, "s") if bars else "", "Time by stage, as shares of each setting's own time, "
                         "which stands at the end."))
    return "".join(parts)


def growth_plots(growths: tuple, styles: dict) -> str:
    """A plot for each axis that grows."""
    parts = []
    for name in dict.fromkeys(line.axis for line in growths):
        series = [_grown(line, styles) for line in growths if line.axis == name]
        parts.append(_figure(line_plot(series, f"{name} (count)", "time (s)"), f"Time over the number of {name}; both "
                             "axes logarithmic, so that a straight line of slope one is linear growth."))
    return "".join(parts)


def cost_table(costs: tuple, setting: str) -> str:
    """Counted work beside what the model of the talk predicts."""
    kinds = list(dict.fromkeys(kind for cost in costs for kind in (*cost.predicted, *cost.measured)))
    heads = "".join(f'<th colspan="2">{escape(kind)}<br><small>counted / predicted</small></th>' for kind in kinds)
    rows = "".join(f'<tr><th scope="row">{escape(cost.title)}</th>'
                   + "".join(f"<td>{_count(cost.measured, kind)}</td><td>{_count(cost.predicted, kind)}</td>"
                             for kind in kinds) + f'<td class="words">{escape(cost.explanation)}</td></tr>'
                   for cost in costs)
    return (f"<p>{escape(setting)}</p>" if setting else "") + (
        f'<div class="wide"><table class="numbers"><thead><tr><th>method</th>{heads}<th>why they differ</th></tr>'
        f"</thead><tbody>{rows}</tbody></table></div>")


def _plot(scene: Scene, styles: dict, path: str, label: str, x_label: str, cost) -> str:
    """Error over cost of every method; empty where nothing has both."""
    lines: dict = {}
    for run in scene.runs:
        error, spent = number(run.numbers, path), cost(run)
        if error is not None and spent:
            lines.setdefault(run.method, []).append((spent, error, run))
    series = []
    for method, points in lines.items():
        points.sort(key=lambda point: (point[2].value is None, point[2].value))
        series.append(Series(points[0][2].title, styles[method], tuple(point[0] for point in points),
                             tuple(point[1] for point in points),
                             tuple(f"{run.label}: {short(spent)}, {error:.3g}" for spent, error, run in points)))
    return line_plot(series, x_label, label, front=True) if series else ""


def _grown(line: Growth, styles: dict) -> Series:
    titles = tuple(f"{line.title}: {short(size)}, {seconds:.3g} s" for size, seconds in zip(line.sizes, line.seconds))
    return Series(line.title, styles[line.method], line.sizes, line.seconds, titles)


def _figure(plot: str, caption: str) -> str:
    return f'<figure class="plot">{plot}<figcaption>{escape(caption)}</figcaption></figure>' if plot else ""


def _count(counts: dict, kind: str) -> str:
    return short(float(counts[kind])) if kind in counts else "–"
