"""The report as one HTML page that needs nothing else: no network, no scripts, pictures and plots inside."""
from __future__ import annotations

import base64
from html import escape

from .report_data import Report, Run, Scene, number
from .report_plots import cost_table, growth_plots, scene_plots, styles_of
from .report_style import STYLE

# what the overview and the table of methods show: a heading, the path of the number, its format
COLUMNS = (("mean error over the area (px)", "area.mean_error_px", ".4f"),
           ("99 % over the area (px)", "area.displacement_px.p99", ".3f"),
           ("holes, spill, wrong layer over the area (%)", "area.coverage_percent.all", ".3f"),
           ("mean error at centres (px)", "mean_error_px", ".4f"),
           ("displacement, median (px)", "displacement_px.median", ".3f"),
           ("99 % (px)", "displacement_px.p99", ".3f"),
           ("holes, spill, wrong layer (%)", "coverage_percent.all", ".4f"),
           ("PSNR (dB)", "picture.mirror.psnr", ".1f"), ("SSIM", "picture.mirror.ssim", ".4f"),
           ("FLIP", "picture.mirror.flip", ".4f"),
           ("RMSE over what may be lit", "picture.receivers.rmse", ".5f"),
           ("PSNR there (dB)", "picture.receivers.psnr", ".1f"),
           ("RMSE by noise alone", "picture.noise.rmse", ".5f"),
           ("SSIM there", "picture.receivers.ssim", ".4f"), ("FLIP there", "picture.receivers.flip", ".4f"))


def page(report: Report) -> str:
    """Return the report as one HTML page that contains its style sheet, plots (SVG) and pictures (base64)."""
    styles = styles_of(report)
    body = [f"<h1>{escape(report.title)}</h1>"]
    if len(report.scenes) > 1:
        body.append(_overview(report))
    for index, scene in enumerate(report.scenes):
        body.append(_scene(scene, index, styles, heading=len(report.scenes) > 1))
    if report.growths:
        body.append("<h2>How it grows</h2>" + growth_plots(report.growths, styles) + _sentences(report.left_out))
    if report.costs:
        body.append("<h2>Work, counted</h2>" + cost_table(report.costs, report.cost_setting))
    body.append("<h2>How to read this</h2>" + "".join(f"<p>{escape(note)}</p>" for note in report.notes))
    body.append(_facts(report.environment))
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{escape(report.title)}</title><style>{STYLE}</style></head><body><main>"
            + "\n".join(body) + "</main></body></html>\n")


def _overview(report: Report) -> str:
    """One row for each scene: its answer, linked to its section."""
    rows = "".join(f'<tr><th scope="row"><a href="#scene{index}">{escape(scene.name)}</a></th>'
                   f"<td>{escape(scene.summary[0] if scene.summary else '')}</td></tr>"
                   for index, scene in enumerate(report.scenes))
    return f'<table class="overview"><tbody>{rows}</tbody></table>'


def _scene(scene: Scene, index: int, styles: dict, heading: bool) -> str:
    parts = [f'<section id="scene{index}">']
    if heading:
        parts.append(f"<h2>{escape(scene.name)}</h2>")
    if scene.summary:
        parts.append(f'<p class="answer">{escape(scene.summary[0])}</p>')
        parts += [f"<p>{escape(sentence)}</p>" for sentence in scene.summary[1:]]
    parts.append(_pictures(scene.pictures[:2], "pair") + _facts(scene.facts) + _pictures(scene.pictures[2:], "maps"))
    if scene.runs:
        parts.append(scene_plots(scene, styles) + _table(scene.runs) + _sentences(scene.skipped))
    return "".join(parts) + "</section>"


def _pictures(pictures: tuple, kind: str) -> str:
    if not pictures:
        return ""
    figures = []
    for picture in pictures:
        data = base64.b64encode(picture.data).decode("ascii")
        figures.append(f'<figure><img alt="{escape(picture.title)}" src="data:{picture.kind};base64,{data}">'
                       f"<figcaption><b>{escape(picture.title)}.</b> {escape(picture.caption)}</figcaption></figure>")
    return f'<div class="{kind}">{"".join(figures)}</div>'


def _facts(facts: dict) -> str:
    if not facts:
        return ""
    rows = "".join(f'<tr><th scope="row">{escape(str(name))}</th><td>{escape(str(value))}</td></tr>'
                   for name, value in facts.items())
    return f'<table class="facts"><tbody>{rows}</tbody></table>'


def _sentences(sentences: tuple) -> str:
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in sentences)


def _table(runs: tuple) -> str:
    """Every run with its seconds and errors, in the order given; numbers that no run has take no column."""
    kinds = list(dict.fromkeys(kind for run in runs for kind in run.counts))
    columns = [column for column in COLUMNS if any(number(run.numbers, column[1]) is not None for run in runs)]
    heads = "".join(f"<th>{escape(name)}</th>"
                    for name in ["method", "seconds", *(column[0] for column in columns), *kinds])
    return (f'<div class="wide"><table class="numbers"><thead><tr>{heads}</tr></thead><tbody>'
            + "".join(_row(run, columns, kinds) for run in runs) + "</tbody></table></div>")


def _row(run: Run, columns: list, kinds: list) -> str:
    cells = [f"{run.total:.3g}"]
    for _, path, form in columns:
        value = number(run.numbers, path)
        cells.append("–" if value is None else format(value, form))
    cells += [f"{run.counts[kind]:,}".replace(",", " ") if kind in run.counts else "–" for kind in kinds]
    fronts = [name for name, good in run.numbers.get("on_front", {}).items() if good]
    star = f' <b title="on the Pareto front: {", ".join(fronts)}">{"*" * len(fronts)}</b>' if fronts else ""
    cells = "".join(f"<td>{cell}</td>" for cell in cells)
    return f'<tr><th scope="row">{escape(run.label)}{star}</th>{cells}</tr>'
