"""Axes of a plot as SVG: scales, ticks with labels, and the marks that tell methods apart."""
from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

# M. Okabe and K. Ito, "Color Universal Design" (2002): told apart with any kind of colour vision; their yellow is left
# out, since it is too bright for lines on white
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = ("circle", "square", "triangle", "diamond", "down", "pentagon", "plus", "cross", "star")
INK, FAINT, GRID = "#333333", "#767676", "#e4e4e4"
SIZE = 5.0  # of a mark, in the picture's units


@dataclass(frozen=True)
class Axis:
    """A scale from `low` to `high`, drawn from `start` to `end` in the picture's units."""

    label: str
    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = True

    def place(self, value: float) -> float:
        """Return the coordinate at which a value is drawn. Values beyond an end of the axis are drawn at that end."""
        value = min(max(value, self.low), self.high)
        if self.logarithmic:
            share = math.log(value / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[tuple[float, str]]:
        """Values with labels, and without where they are only to be ticked."""
        return _log_ticks(self.low, self.high) if self.logarithmic else _even_ticks(self.low, self.high)


def axis(label: str, values: list, start: float, end: float, logarithmic: bool = True) -> Axis:
    """An axis that holds all `values`; zeros on a logarithmic one are drawn at its end."""
    if not logarithmic:
        return Axis(label, 0.0, max([*values, 1e-12]) * 1.02, start, end, False)
    positive = [value for value in values if value > 0.0 and math.isfinite(value)] or [1.0]
    low, high = min(positive) / 1.25, max(positive) * 1.25
    if high / low < 4.0:        # a few numbers must fit on any axis
        middle = math.sqrt(low * high)
        low, high = middle / 2.0, middle * 2.0
    return Axis(label, low, high, start, end)


def _log_ticks(low: float, high: float) -> list[tuple[float, str]]:
    decades = math.log10(high / low)
    wanted = (1, 2, 5) if decades < 1.7 else (1,)
    # with many decades only every second or third is labelled
    stride = max(1, math.ceil(decades / 7.0))
    found = []
    for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        for digit in range(1, 10):
            value = digit * 10.0 ** power
            if low <= value <= high:
                found.append((value, short(value) if digit in wanted and power % stride == 0 else ""))
    return found


def _even_ticks(low: float, high: float) -> list[tuple[float, str]]:
    rough = (high - low) / 5.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough)
    return [(index * step, short(index * step)) for index in range(math.ceil(low / step), int(high / step) + 1)]


def short(value: float) -> str:
    """A number in few letters: 0.02, 5, 10K, 2M."""
    for size, letter in ((1e9, "G"), (1e6, "M"), (1e3, "K")):
        if abs(value) >= size:
            return f"{value / size:.3g}{letter}"
    if value and abs(value) < 1e-4:
        return f"{value:.0e}".replace("e-0", "e-")
    return f"{value:.4g}"


def draw_axes(across: Axis, up: Axis) -> str:
    """Grid, ticks, labels and names of a horizontal and a vertical axis."""
    left, right, bottom, top = across.start, across.end, up.start, up.end
    parts = []
    for value, label in across.ticks():
        x = across.place(value)
        if label:
            parts.append(f'<line x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{bottom}" stroke="{GRID}"/>')
            parts.append(f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{label}</text>')
        length = 6 if label else 3
        parts.append(f'<line x1="{x:.1f}" y1="{bottom}" x2="{x:.1f}" y2="{bottom + length}" stroke="{INK}"/>')
    for value, label in up.ticks():
        y = up.place(value)
        if label:
            parts.append(f'<line x1="{left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="{GRID}"/>')
            parts.append(f'<text x="{left - 9}" y="{y + 4:.1f}" text-anchor="end">{label}</text>')
        length = 6 if label else 3
        parts.append(f'<line x1="{left - length}" y1="{y:.1f}" x2="{left}" y2="{y:.1f}" stroke="{INK}"/>')
    parts.append(f'<path d="M{left} {top}V{bottom}H{right}" fill="none" stroke="{INK}"/>')
    middle = (left + right) / 2
    parts.append(f'<text x="{middle:.1f}" y="{bottom + 38}" text-anchor="middle">{escape(across.label)}</text>')
    middle = (top + bottom) / 2
    parts.append(f'<text x="15" y="{middle:.1f}" text-anchor="middle" transform="rotate(-90 15 {middle:.1f})">'
                 f"{escape(up.label)}</text>")
    return "".join(parts)


def marker(kind: str, x: float, y: float, colour: str, filled: bool, title: str = "") -> str:
    """A mark at a place; hollow where not `filled`; `title` is shown where the pointer rests."""
    fill = colour if filled else "#ffffff"
    style = f'fill="{fill}" stroke="{colour}" stroke-width="1.6"'
    inner = f"<title>{escape(title)}</title>" if title else ""
    if kind == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{SIZE}" {style}>{inner}</circle>'
    if kind in ("plus", "cross"):
        arm, end, turn = 0.45 * SIZE, 1.25 * SIZE, 45 if kind == "cross" else 0
        corners = [(-arm, -end), (arm, -end), (arm, -arm), (end, -arm), (end, arm), (arm, arm), (arm, end), (-arm, end),
                   (-arm, arm), (-end, arm), (-end, -arm), (-arm, -arm)]
    else:
        count, turn = {"square": (4, 45), "diamond": (4, 0), "triangle": (3, 0), "down": (3, 180), "pentagon": (5, 0),
                       "star": (10, 0)}[kind]
        corners = [(1.25 * SIZE * (0.5 if kind == "star" and k % 2 else 1.0) * math.sin(2 * math.pi * k / count),
                    -1.25 * SIZE * (0.5 if kind == "star" and k % 2 else 1.0) * math.cos(2 * math.pi * k / count))
                   for k in range(count)]
    points = " ".join(f"{px:.1f},{py:.1f}" for px, py in corners)
    return f'<polygon points="{points}" transform="translate({x:.1f} {y:.1f}) rotate({turn})" {style}>{inner}</polygon>'
