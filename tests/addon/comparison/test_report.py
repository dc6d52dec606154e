"""The report: what it draws against NumPy, brute force and matplotlib; a page that needs nothing else."""
from __future__ import annotations

import base64
import csv
import io
import json
import math
import re
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    names = ("report.colour_map", "comparison.compare_images", "metrics.pixel_errors", "report.png_file",
             "report.report_data", "report.report_page", "report.svg_axes", "report.svg_plots")
    return SimpleNamespace(**{name.rpartition(".")[2]: room(f"addon.{name}") for name in names})


def decoded(data: bytes, folder) -> np.ndarray:
    """The pixels of a PNG as Blender reads it, (height, width, 3) uint8 from the highest row down."""
    path = folder / "picture.png"
    path.write_bytes(data)
    image = bpy.data.images.load(str(path))
    try:
        pixels = np.empty(image.size[0] * image.size[1] * image.channels, dtype=np.float32)
        image.pixels.foreach_get(pixels)
        return np.rint(255 * pixels.reshape(image.size[1], image.size[0], -1)[::-1, :, :3]).astype(np.uint8)
    finally:
        bpy.data.images.remove(image)


def whole_report(rooms, data: bytes = b"\x89PNG"):
    """A report in which everything occurs, with names that HTML would misread."""
    data_room = rooms.report_data
    runs = tuple(
        data_room.Run(method, f"{method} <&>", "tolerance", value, {"see": 0.1 * base, "cull": 0.3 * base},
                      {"projections": int(1000 * base)},
                      {"displacement_px": {"median": 0.1 / base, "p99": 1.0 / base}, "coverage_percent": {"all": 0.1},
                       "picture": {"mirror": {"psnr": None, "ssim": 0.9, "flip": 0.01 / base}}})
        for method, base in (("GENERAL", 1.0), ("RAYS", 7.0)) for value in (0.5, 1.0) for base in (base / value,))
    picture = data_room.Picture("result", 'With "quotes"', "A caption.", data)
    scene = data_room.Scene("Sphere & Co", ("It is worth it.", "Really."), {"a": 1}, (picture, picture), runs)
    growth = data_room.Growth("GENERAL", "General", "diffuse vertices", (1e3, 1e4, 1e6), (0.01, 0.02, 3.0))
    cost = data_room.Cost("RAYS", "Rays", {"Ti": 1_900_000}, {"Ti": 2_000_000}, "Pixels without a mirror cost nothing.")
    return data_room.Report("Title", (scene, scene), (growth,), (cost,), "1M pixels", {"Blender": "4.2"}, ("A note.",))


# ---- data ---------------------------------------------------------------------------------------------------------

def test_the_front_is_what_nothing_beats(rooms):
    rng = np.random.default_rng(1)
    costs, errors = rng.integers(0, 12, (2, 60)).astype(float)
    beaten = [any(costs[k] <= costs[i] and errors[k] <= errors[i] and (costs[k], errors[k]) != (costs[i], errors[i])
                  for k in range(60)) for i in range(60)]
    np.testing.assert_array_equal(rooms.report_data.pareto(costs, errors), ~np.array(beaten))


def test_rows_come_back_from_the_table(rooms):
    rows = rooms.report_data.run_rows(whole_report(rooms))
    read = list(csv.DictReader(io.StringIO(rooms.report_data.csv_text(rows + [{"other": 'a,"b"'}]))))
    assert len(read) == 2 * 4 + 1
    assert read[-1]["other"] == 'a,"b"' and read[-1]["method"] == ""
    assert float(read[0]["seconds.total"]) == pytest.approx(0.8)
    assert float(read[0]["displacement_px.p99"]) == pytest.approx(0.5)
    assert read[0]["count.projections"] == "2000" and read[0]["value"] == "0.5"


def test_the_document_is_json_without_pictures(rooms):
    content = json.loads(json.dumps(rooms.report_data.document(whole_report(rooms))))
    assert content["scenes"][0]["runs"][0]["seconds"] == pytest.approx({"see": 0.2, "cull": 0.6})
    assert content["scenes"][0]["pictures"][0] == {"name": "result", "title": 'With "quotes"', "caption": "A caption.",
                                                   "kind": "image/png"}


def test_stages_are_timed_from_when_they_are_told(rooms, monkeypatch):
    """A clock that each step moves on by hand; a stage that comes again goes on where it was."""
    clock = SimpleNamespace(now=5.0)
    monkeypatch.setattr(rooms.report_data.time, "perf_counter", lambda: clock.now)

    def steps():
        clock.now += 0.5
        for stage, seconds in (("see", 1.0), ("cull", 2.0), ("see", 4.0)):
            yield 0.1, stage
            clock.now += seconds
        return "mesh"

    assert rooms.report_data.timed(steps()) == ("mesh", {"start": 0.5, "see": 5.0, "cull": 2.0})


# ---- colours ------------------------------------------------------------------------------------------------------

def test_colours_are_those_of_viridis(rooms):
    matplotlib = pytest.importorskip("matplotlib")
    steps = rooms.colour_map.STEPS
    expected = 255 * matplotlib.colormaps["viridis"].resampled(steps)(np.arange(steps))[:, :3]
    assert np.abs(rooms.colour_map.palette()[:steps] - expected).max() < 3.0


def test_lightness_grows_evenly(rooms):
    """The scale stays readable in grey and with any colour vision: CIE lightness rises at each step, and alike."""
    linear = (rooms.colour_map.palette()[:rooms.colour_map.STEPS] / 255.0 + 0.055) / 1.055
    light = 116.0 * np.cbrt((linear ** 2.4) @ (0.2126, 0.7152, 0.0722)) - 16.0
    steps = np.diff(light[::20])
    assert (steps > 0.0).all() and steps.max() < 2.0 * steps.min()


def test_a_png_holds_what_it_was_given(rooms, tmp_path):
    rng = np.random.default_rng(2)
    indices, colours = rng.integers(0, 200, (13, 17)).astype(np.uint8), rng.integers(0, 256, (200, 3)).astype(np.uint8)
    found = decoded(rooms.png_file.png_bytes(indices, colours), tmp_path)
    np.testing.assert_array_equal(found, colours[indices])


def test_a_heat_map_colours_by_powers_of_ten(rooms, tmp_path):
    values = np.array([[1e-5, 1e-2], [1e-1, 1.0], [np.nan, 50.0]]).repeat(150, axis=1)
    found, colours = decoded(rooms.colour_map.heat_map(values, 1e-3, 1.0, "px"), tmp_path), rooms.colour_map.palette()
    steps = rooms.colour_map.STEPS
    # from the highest row down: the last row of the values comes first
    rows = [[colours[rooms.colour_map.NO_VALUE], colours[steps - 1]], [colours[2 * steps // 3], colours[steps - 1]],
            [colours[0], colours[steps // 3]]]
    for row, expected in enumerate(rows):
        for column, colour in zip((0, 299), expected):
            assert np.abs(found[row, column].astype(int) - colour).max() <= 3
    bar = found[3 + 1 + 2]
    assert np.abs(bar[3].astype(int) - colours[0]).max() <= 3
    assert np.abs(bar[-4].astype(int) - colours[steps - 1]).max() <= 3
    assert found.shape[0] > 3 + 12


def test_numbers_of_the_scale_are_written(rooms):
    """Each is drawn where its power of ten lies on the bar."""
    room = rooms.colour_map
    drawn = room.scale(400, 0.01, 10.0, "px") == room.INK
    assert not drawn[:14, 10:390].any(axis=0).all()
    for step, text in enumerate(("0.01", "0.1", "1", "10 px")):
        written = room.glyphs(text, 2)
        column = 6 + round(387 * step / 3)
        start = min(max(column - written.shape[1] // 2, 2), 400 - written.shape[1] - 2)
        rows = drawn[-14:, start:start + written.shape[1]]
        np.testing.assert_array_equal(rows[:10], written)


def test_wrong_pixels_show_in_a_large_picture(rooms):
    shape = (900, 900)
    empty = np.zeros(shape, dtype=bool)
    hole, mirror = empty.copy(), ~empty
    hole[450, 300] = True
    measurement = rooms.pixel_errors.Measurement(np.zeros(shape), mirror, mirror, hole, empty, empty, {})
    names = list(rooms.compare_images.KINDS)
    picture = rooms.compare_images.coverage_picture(measurement)
    where = np.argwhere(picture == names.index("hole"))
    assert where.min(axis=0).tolist() == [448, 298] and where.max(axis=0).tolist() == [452, 302] and len(where) == 25
    assert (picture == names.index("right")).sum() == 900 * 900 - 25


def test_maps_show_the_surroundings_of_the_mirror(rooms):
    mirror = np.zeros((100, 300), dtype=bool)
    assert mirror[rooms.compare_images.surroundings(mirror)].shape == mirror.shape
    mirror[40:61, 0], mirror[50, 199] = True, True
    rows, columns = rooms.compare_images.surroundings(mirror)
    assert (rows.start, rows.stop, columns.start, columns.stop) == (37, 64, 0, 211)


# ---- plots --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize(("low", "high"), [(0.07, 0.3), (3e-4, 2e6), (1.0, 40.0)])
def test_ticks_lie_within_their_axis_and_say_their_value(rooms, low, high):
    axis = rooms.svg_axes.axis("x", [low, high], 100.0, 500.0)
    labelled = [(value, label) for value, label in axis.ticks() if label]
    assert 2 <= len(labelled) <= 9
    letters = {"K": 1e3, "M": 1e6, "G": 1e9}
    for value, label in labelled:
        assert axis.low <= value <= axis.high
        assert float(label.rstrip("KMG")) * letters.get(label[-1], 1.0) == pytest.approx(value)
    for value, _ in axis.ticks():
        expected = 100.0 + 400.0 * math.log(value / axis.low) / math.log(axis.high / axis.low)
        assert axis.place(value) == pytest.approx(expected)
    assert axis.place(0.0) == 100.0 and axis.place(1e30) == 500.0


def test_points_are_drawn_where_they_lie_and_the_front_is_filled(rooms):
    series = [rooms.svg_plots.Series("A", 0, (1.0, 10.0), (10.0, 1.0), ("a1", "a2")),
              rooms.svg_plots.Series("B", 1, (100.0,), (10.0,), ("b",))]
    tree = ElementTree.fromstring(rooms.svg_plots.line_plot(series, "time (s)", "error (px)", front=True))
    circles = [mark for mark in tree.iter(f"{SVG}circle") if mark.find(f"{SVG}title") is not None]
    assert [mark.find(f"{SVG}title").text for mark in circles] == ["a1", "a2"]
    (x1, y1), (x2, y2) = ((float(mark.get("cx")), float(mark.get("cy"))) for mark in circles)
    square = next(mark for mark in tree.iter(f"{SVG}polygon") if mark.find(f"{SVG}title") is not None)
    x3, y3 = map(float, re.match(r"translate\((\S+) (\S+)\)", square.get("transform")).groups())
    # one decade to the right is as wide as the next; up is better seen as more
    assert x2 - x1 == pytest.approx(x3 - x2, abs=0.2) and x2 > x1 and y2 > y1
    assert y3 == pytest.approx(y1, abs=0.2)
    assert [mark.get("fill") != "#ffffff" for mark in (*circles, square)] == [True, True, False]
    texts = [text.text for text in tree.iter(f"{SVG}text")]
    assert {"time (s)", "error (px)", "A", "B", "Pareto front"} <= set(texts)


def test_bars_are_shares_and_small_parts_are_folded(rooms):
    rows = [("first", {f"stage {k}": 1.0 + k for k in range(12)}), ("second", {"stage 11": 2.0})]
    tree = ElementTree.fromstring(rooms.svg_plots.bar_plot(rows, "s"))
    bars: dict = {}
    for bar in tree.iter(f"{SVG}rect"):
        if bar.find(f"{SVG}title") is not None:
            bars.setdefault(bar.get("y"), []).append((float(bar.get("width")), bar.find(f"{SVG}title").text))
    first, second = bars.values()
    assert sum(width for width, _ in first) == pytest.approx(sum(width for width, _ in second), abs=0.1)
    assert len(first) == 9 and len(second) == 1
    shown = {text.split(":")[0]: width for width, text in first}
    assert shown["stage 11"] / shown["the rest"] == pytest.approx(12.0 / (1 + 2 + 3 + 4), rel=0.01)
    assert {"78 s", "2 s"} <= {text.text for text in tree.iter(f"{SVG}text")}


def test_methods_are_told_apart_without_colour(rooms):
    """No two methods share colour and marker, and neighbours in Okabe and Ito's set share neither."""
    looks = [rooms.svg_plots._style(number) for number in range(20)]
    assert len(set(looks)) == 20
    assert all(first[0] != second[0] and first[1] != second[1] for first, second in zip(looks, looks[1:]))


# ---- the page -----------------------------------------------------------------------------------------------------

class Reader(HTMLParser):
    """Collects what a page would load, and checks that its elements are closed in order."""

    VOID = {"meta", "img", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.loaded, self.tags = [], [], []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in self.VOID:
            self.open.append(tag)
        self.loaded += [value for name, value in attributes if name in ("src", "href", "srcset", "data", "action")]

    def handle_startendtag(self, tag, attributes):
        self.tags.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_needs_nothing_else(rooms):
    page = rooms.report_page.page(whole_report(rooms))
    reader = Reader()
    reader.feed(page)
    assert reader.open == []
    assert not {"script", "link", "iframe", "object"} & set(reader.tags)
    assert all(address.startswith(("data:image/", "#scene")) for address in reader.loaded)
    assert "@import" not in page and "url(" not in page
    assert base64.b64encode(b"\x89PNG").decode() in page
    assert "Sphere &amp; Co" in page and "GENERAL &lt;&amp;&gt;" in page and "<&>" not in page
    # the answer stands before the first picture of its scene
    assert page.index("It is worth it.") < page.index("<img")
    for svg in re.findall(r"<svg.*?</svg>", page, re.DOTALL):
        ElementTree.fromstring(svg)
    # for each scene error over time twice, over projections, and stages; growth once
    assert page.count("<svg") == 2 * 4 + 1


def test_the_answer_tells_of_what_is_wrong(room):
    """A reflection that is close wherever it shows something is still no good where it shows nothing."""
    report = {"judged_pixels": 1000, "displacement_px": {"median": 0.04, "p99": 0.26},
              "coverage_percent": {"all": 12.5}, "generate_seconds": 0.5, "picture": {"samples": 1, "mirror": {}},
              "render_seconds": {"reference": 3.0, "result": 2.0}}
    page = room("addon.comparison.compare_page")
    answer, more = page.summary(report)
    assert "87.50 % of the mirror" in answer and "0.26 px" in answer and "0.50 s" in answer
    assert "3.0 s" in answer and "1 sample a pixel" in answer and "125 of 1000 pixels" in more
    report["displacement_px"] = dict.fromkeys(("median", "p99"))
    assert "nothing that could be measured" in page.summary(report)[0]
    assert "no mirror" in page.summary({"judged_pixels": 0})[0]
