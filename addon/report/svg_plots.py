"""Plots as SVG text: points joined by lines on logarithmic axes with the Pareto front, and stacked bars."""
from __future__ import annotations

from dataclasses import dataclass
from html import escape

from .report_data import pareto
from .svg_axes import COLOURS, FAINT, GRID, INK, MARKERS, Axis, axis, draw_axes, marker, short

WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 780, 420, 66, 52, 14
LETTER = 7.6            # the width of one, at most, where no font can be asked
REST = "the rest"
# their yellow, too bright for lines, does for areas
AREAS = (*COLOURS, "#F0E442")


@dataclass(frozen=True)
class Series:
    """Points of one method: places, a title for each, and a number that chooses colour and marker."""

    name: str
    style: int
    x: tuple
    y: tuple
    titles: tuple


def line_plot(series: list[Series], x_label: str, y_label: str, front: bool = False, marks: tuple = ()) -> str:
    """Series on logarithmic axes. With `front`, points that no other beats are filled and joined by a staircase.
    `marks` are (label, x) of upright lines."""
    longest = max([len(line.name) for line in series] + [22 if front else 0])
    bottom, right = HEIGHT - BOTTOM, WIDTH - 50 - LETTER * longest
    across = axis(x_label, [x for line in series for x in line.x] + [x for _, x in marks], LEFT, right)
    up = axis(y_label, [y for line in series for y in line.y], bottom, TOP)
    points = [(x, y) for line in series for x, y in zip(line.x, line.y)]
    best = pareto(*zip(*points)) if front and points else [True] * len(points)
    parts = [draw_axes(across, up)]
    if front and points:
        parts.append(_staircase(sorted({point for point, good in zip(points, best) if good}), across, up))
    index = 0
    for line in series:
        colour, kind = _style(line.style)
        places = [(across.place(x), up.place(y)) for x, y in zip(line.x, line.y)]
        way = "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
        parts.append(f'<path d="M{way}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        for (x, y), title in zip(places, line.titles):
            parts.append(marker(kind, x, y, colour, bool(best[index]), title))
            index += 1
    parts += [_mark(across.place(x), label) for label, x in marks]
    parts.append(_legend([(line.name, *_style(line.style)) for line in series], right + 18, front))
    return _picture(parts, HEIGHT)


def _mark(x: float, label: str) -> str:
    """A dashed upright line with its name along it."""
    bottom = HEIGHT - BOTTOM - 8
    return (f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="{FAINT}" stroke-dasharray="5 4" fill="none"/>'
            f'<text x="{x - 5:.1f}" y="{bottom}" fill="{FAINT}" stroke="#ffffff" stroke-width="3" paint-order="stroke" '
            f'transform="rotate(-90 {x - 5:.1f} {bottom})">'
            f"{escape(label)}</text>")


def bar_plot(rows: list[tuple[str, dict]], unit: str) -> str:
    """A bar for each (label, {part: amount}), as long as the others: its parts as shares, its sum at the end."""
    sums: dict = {}
    for _, amounts in rows:
        for name, amount in amounts.items():
            sums[name] = sums.get(name, 0.0) + amount / sum(amounts.values())
    names = sorted(sums, key=sums.get, reverse=True)[:len(AREAS)]
    names = [name for name in sums if name in names] + ([REST] if len(sums) > len(names) else [])
    colours = dict(zip(names, (*AREAS[:len(names) - (REST in names)], "#b0b0b0")))
    left, right, step, top = 20 + LETTER * max(len(label) for label, _ in rows), WIDTH - 80, 26, 12
    legend, legend_height = _bar_legend(colours, left, top)
    top += legend_height
    bottom = top + step * len(rows) + 6
    across = Axis("", 0.0, 100.0, left, right, logarithmic=False)
    parts = [legend]
    for value, label in across.ticks():
        x = across.place(value)
        parts.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="{GRID}"/>'
                     f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{label}</text>')
    for row, (label, amounts) in enumerate(rows):
        y, x, total = top + 6 + step * row, left, sum(amounts.values())
        parts.append(f'<text x="{left - 8:.1f}" y="{y + 13}" text-anchor="end">{escape(label)}</text>')
        folded = {name: amounts.get(name, 0.0) for name in names}
        if REST in names:
            folded[REST] = sum(amount for name, amount in amounts.items() if name not in names)
        for name, amount in folded.items():
            width = (right - left) * amount / total
            parts.append(f'<rect x="{x:.2f}" y="{y}" width="{width:.2f}" height="18" stroke="#ffffff" '
                         f'stroke-width="0.5" fill="{colours[name]}"><title>{escape(name)}: {amount:.3g} {unit}</title>'
                         "</rect>" if amount else "")
            x += width
        parts.append(f'<text x="{right + 8:.1f}" y="{y + 13}">{short(float(f"{total:.3g}"))} {unit}</text>')
    parts.append(f'<path d="M{left:.1f} {top}V{bottom}H{right}" fill="none" stroke="{INK}"/>')
    parts.append(f'<text x="{(left + right) / 2:.1f}" y="{bottom + 38}" text-anchor="middle">share (%)</text>')
    return _picture(parts, bottom + 48)


def _style(number: int) -> tuple[str, str]:
    """Colour and marker: seven and nine of them, so that 63 methods differ."""
    return COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]


def _staircase(points: list, across, up) -> str:
    """The border of what is beaten: from point to point first right, then down, as long as the plot."""
    x, y = across.place(points[0][0]), up.place(points[0][1])
    way = f"M{x:.1f} {up.end:.1f}V{y:.1f}"
    for point in points[1:]:
        way += f"H{across.place(point[0]):.1f}V{up.place(point[1]):.1f}"
    return (f'<path d="{way}H{across.end:.1f}" fill="none" stroke="#b0b0b0" stroke-width="5" stroke-linejoin="round" '
            'opacity="0.65"/>')


def _legend(entries: list, x: float, front: bool) -> str:
    parts = []
    for row, (name, colour, kind) in enumerate(entries):
        y = TOP + 12 + 21 * row
        parts.append(f'<path d="M{x} {y}h22" stroke="{colour}" stroke-width="1.5"/>'
                     + marker(kind, x + 11, y, colour, True) + f'<text x="{x + 30}" y="{y + 4}">{escape(name)}</text>')
    if front:
        y = TOP + 24 + 21 * len(entries)
        parts.append(f'<path d="M{x} {y}h22" stroke="#b0b0b0" stroke-width="5"/><text x="{x + 30}" y="{y + 4}">Pareto '
                     f'front</text><text x="{x}" y="{y + 22}" fill="{FAINT}">filled: nothing else is as</text>'
                     f'<text x="{x}" y="{y + 38}" fill="{FAINT}">good in both; better is</text>'
                     f'<text x="{x}" y="{y + 54}" fill="{FAINT}">to the left and below</text>')
    return "".join(parts)


def _bar_legend(colours: dict, left: float, top: float) -> tuple[str, float]:
    """Names of the parts in lines from `left` on, and the height that they take."""
    parts, x, y = [], left, top
    for name, colour in colours.items():
        width = 30 + LETTER * len(name)
        if x + width > WIDTH and x > left:
            x, y = left, y + 20
        parts.append(f'<rect x="{x:.1f}" y="{y}" width="12" height="12" fill="{colour}"/>'
                     f'<text x="{x + 18:.1f}" y="{y + 11}">{escape(name)}</text>')
        x += width
    return "".join(parts), y - top + 22


def _picture(parts: list, height: float) -> str:
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}" role="img" '
            f'font-family="Helvetica, Arial, sans-serif" font-size="13" fill="{INK}">' + "".join(parts) + "</svg>")
