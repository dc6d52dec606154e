"""The plots of a report: which numbers against which, and what each shows."""
from __future__ import annotations

from html import escape

from .report_data import LEAST, Growth, Report, Scene, number
from .svg_axes import short
from .svg_plots import Series, bar_plot, line_plot

# errors that are plotted: their path, their axis, what there is to say of it, and what is drawn as no less
ERRORS = (("area.mean_error_px", "mean error over the pixels' area (px)", "Displacement, at most a pixel, at places "
           "anywhere in the pixels; a hole, spill or wrong layer counts as one. What the forward method makes is "
           "geometry, so it is asked between the pixels' centres too; a traced picture shows its nearest sample there.",
           LEAST),
          ("mean_error_px", "mean error at the pixels' centres (px)", "The same at the pixels' centres alone, where "
           "ray tracing is exact by definition: the truth takes the same rays. Less than 0.001 px is drawn as that.",
           LEAST),
          ("displacement_px.p99", "displacement, 99th percentile (px)", "", 1e-4),
          ("picture.mirror.flip", "FLIP (0 equal, 1 worst)", "", 0.0),
          ("picture.receivers.rmse", "RMSE over what may be lit (linear light)", "Against Cycles' own caustics, "
           "converged.", 0.0))
KINDS = ("intersections", "traversals", "projections", "rays")


def styles_of(report: Report) -> dict:
    """A number for each method, by which it has the same colour and marker in all plots."""
    methods = [run.method for scene in report.scenes for run in scene.runs] + [line.method for line in report.growths]
    return {method: index for index, method in enumerate(dict.fromkeys(methods))}


def scene_plots(scene: Scene, styles: dict) -> str:
    """Errors against seconds and against work, and time by stage."""
    return "".join(_figure(plot, caption) for _, plot, caption in _scene_plots(scene, styles))


def plot_files(report: Report) -> dict:
    """Every plot of a report as an SVG text, by the name of its file."""
    styles, files = styles_of(report), {}
    for scene in report.scenes:
        files.update({f"{scene.name}_{name}.svg": plot for name, plot, _ in _scene_plots(scene, styles) if plot})
    files.update({f"growth_{axis.replace(' ', '_')}.svg": plot for axis, plot in _growth_plots(report.growths, styles)})
    return files


def _scene_plots(scene: Scene, styles: dict) -> list[tuple[str, str, str]]:
    """(name, SVG, caption) of each plot; empty where nothing has what it shows."""
    known = [error for error in ERRORS if any(number(run.numbers, error[0]) is not None for run in scene.runs)]
    plots = []
    for error in known:
        plots.append((error[0].replace(".", "_"),
                      _plot(scene, styles, error, "time to the reflection (s)", lambda run: run.total, front=True),
                      f"Error against time, both logarithmic: {error[1]}. {error[2]} Lines join the settings of one "
                      "method."))
    for kind in KINDS if known else ():
        plot = _plot(scene, styles, known[0], f"{kind} (count)", lambda run, kind=kind: run.counts.get(kind))
        plots.append((f"work_{kind}", plot, f"Error against counted work: {kind}. Methods that do none of it are left "
                      "out."))
    for name, forward in (("stages", True), ("stages_others", False)):
        # a forward method says how long it takes without being drawn
        bars = [(f"{run.title}: {run.value:g}" if run.knob else run.title, run.seconds) for run in _one_each(scene.runs)
                if run.total > 0.0 and forward == bool({"cameras", "rays", "solve"} & set(run.seconds))]
        plots.append((name, bar_plot(bars, "s") if bars else "", "Time by stage, as shares of each setting's own time, "
                      "which stands at the end; of each method the middle one of its settings."))
    return plots


def _one_each(runs: tuple) -> list:
    """The middle run of each method."""
    found: dict = {}
    for run in runs:
        found.setdefault(run.method, []).append(run)
    return [own[len(own) // 2] for own in found.values()]


def growth_plots(growths: tuple, styles: dict) -> str:
    """A plot for each axis that grows."""
    return "".join(_figure(plot, f"Time over the number of {axis}; both axes logarithmic, so that a straight line of "
                           "slope one is linear growth.") for axis, plot in _growth_plots(growths, styles))


def _growth_plots(growths: tuple, styles: dict) -> list[tuple[str, str]]:
    axes = dict.fromkeys(line.axis for line in growths)
    return [(axis, line_plot([_grown(line, styles) for line in growths if line.axis == axis and line.sizes],
                             f"{axis} (count)", "time (s)")) for axis in axes]


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


def _plot(scene: Scene, styles: dict, error: tuple, x_label: str, cost, front: bool = False) -> str:
    """Error over cost of every method; empty where nothing has both. `front` marks the references' times too."""
    path, label, _, least = error
    lines: dict = {}
    for run in scene.runs:
        found, spent = number(run.numbers, path), cost(run)
        if found is not None and spent:
            lines.setdefault(run.method, []).append((spent, found, run))
    series = []
    for method, points in lines.items():
        series.append(Series(points[0][2].title, styles[method], tuple(point[0] for point in points),
                             tuple(max(point[1], least) for point in points),
                             tuple(f"{run.label}: {short(spent)}, {found:.3g}" for spent, found, run in points)))
    return line_plot(series, x_label, label, front=True, marks=scene.references if front else ()) if series else ""


def _grown(line: Growth, styles: dict) -> Series:
    titles = tuple(f"{line.title}: {short(size)}, {seconds:.3g} s" for size, seconds in zip(line.sizes, line.seconds))
    return Series(line.title, styles[line.method], line.sizes, line.seconds, titles)


def _figure(plot: str, caption: str) -> str:
    return f'<figure class="plot">{plot}<figcaption>{escape(caption)}</figcaption></figure>' if plot else ""


def _count(counts: dict, kind: str) -> str:
    return short(float(counts[kind])) if kind in counts else "–"
