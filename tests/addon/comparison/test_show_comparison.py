"""The last comparison in Blender: its pictures as images, in an image editor and in the panel."""
from __future__ import annotations

import csv
import io
import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    names = ("interface.draw_work", "report.png_file", "comparison.show_comparison")
    return SimpleNamespace(**{name.rpartition(".")[2]: room(f"addon.{name}") for name in names})


def test_pictures_are_images_of_their_own_and_are_renewed(rooms, blank, tmp_path):
    names = rooms.show_comparison.REFLECTION_PICTURES

    def written(value):
        for name in names:
            data = rooms.png_file.png_bytes(np.zeros((4, 4), dtype=np.uint8), np.array([[value] * 3]))
            (tmp_path / f"{name}.png").write_bytes(data)
        return rooms.show_comparison.load_pictures(str(tmp_path), names)

    first = written(0)
    assert [image.name for image in first] == [f"Reflection Comparison {name.title()}" for name in names]
    assert first[-1].pixels[0] == 0.0
    second = written(255)
    assert [image.as_pointer() for image in first] == [image.as_pointer() for image in second]
    assert second[-1].pixels[0] == 1.0


class Layout:
    """Takes what a panel draws."""

    def __init__(self):
        self.labels, self.made = [], []

    def box(self):
        return self

    def label(self, text, icon, translate):
        self.labels.append(text)

    def operator(self, name, text, icon):
        assert name == "wm.url_open"
        self.made.append(SimpleNamespace())
        return self.made[-1]


@pytest.mark.parametrize(("kind", "pinned", "shown"), [("IMAGE_EDITOR", False, True), ("IMAGE_EDITOR", True, False),
                                                       ("VIEW_3D", False, False)])
def test_only_an_open_image_editor_shows_the_picture(rooms, kind, pinned, shown):
    before, picture = object(), object()
    space = SimpleNamespace(image=before, use_image_pin=pinned)
    area = SimpleNamespace(type=kind, ui_type=kind, spaces=SimpleNamespace(active=space))
    manager = SimpleNamespace(windows=[SimpleNamespace(screen=SimpleNamespace(areas=[area]))])
    assert rooms.show_comparison.show_picture(manager, picture) is shown
    assert space.image is (picture if shown else before)


def test_the_panel_shows_the_last_comparison(rooms, blank, tmp_path):
    scene = blank.scene
    assert rooms.show_comparison.lines(scene) == [] and rooms.show_comparison.page_address(scene) == ""
    bpy.ops.mesh.primitive_plane_add(size=4.0, location=(0.0, 2.0, 1.0), rotation=(1.2, 0.0, 0.0))
    mirror = bpy.context.object
    bpy.ops.mesh.primitive_plane_add(size=9.0, location=(0.0, -4.0, 6.0), rotation=(0.4, 0.0, 0.0))
    mirror.select_set(True)
    bpy.context.view_layer.objects.active = mirror
    scene.render.resolution_x = scene.render.resolution_y = 48
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    report = json.loads((tmp_path / "report.json").read_text())
    told = rooms.show_comparison.lines(scene)
    assert told[0] == "Against Cycles at 48 x 48"
    assert f"{report['displacement_px']['p99']:.3f} px" in told[1]
    assert f"{report['picture']['mirror']['flip']:.4f}" in told[3]
    assert rooms.show_comparison.page_address(scene) == (tmp_path / "report.html").as_uri()
    layout = Layout()
    rooms.draw_work.draw_comparison(layout, bpy.context)
    assert layout.labels == told and layout.made[0].url == (tmp_path / "report.html").as_uri()
    assert report["generate_seconds"] > 0.0 and set(report["render_seconds"]) == {"reference", "result"}
    table = next(csv.DictReader(io.StringIO((tmp_path / "report.csv").read_text())))
    assert float(table["displacement_px.p99"]) == report["displacement_px"]["p99"]
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("<img") == 5 and f"{report['displacement_px']['p99']:.2f} px" in page
