"""What a file tells of earlier work is believed as far as it can be, read once, and leads nowhere."""
from __future__ import annotations

import io
import json
import os
from pathlib import Path
from types import SimpleNamespace

import bpy
import parts
import pytest

GOOD = {"results": ["Mirror Reflection"], "resolution": [64, 48], "median": 0.05, "p99": 0.25, "coverage": 0.5,
        "psnr": 30.0, "ssim": 0.99, "flip": 0.01}
HOSTILE = ["{", "[]", "3", "null", '"text"', "true", "[" * 100_000, "x" * 1_000_000, "NaN", "1" * 10_000,
           "{\"resolution\": " + "9" * 5000 + "}"]
SPOILT = [{"resolution": value} for value in (None, 3, [], [64], [64, 48, 3], ["64", 48], [64.5, 48], [-1, 4],
                                              [True, 4], [10**400, 4], {"a": 1})]
SPOILT += [{name: value} for name in ("median", "p99", "coverage", "psnr", "ssim", "flip")
           for value in ("0.1", [], {}, True, float("nan"), float("inf"), 10**400, 1e300)]
SPOILT += [{"coverage": None}, {"p99": None}, {"median": None}, {"flip": None}, {"ssim": None}]
NOT_COUNTS = HOSTILE + [json.dumps({"filled_pixels": value, "mirror_pixels": other, "depth": value})
                        for value, other in ((None, 3), ("7", 3), ([], 3), (float("nan"), 3), (-4, 3), (10**400, 3),
                                             (True, 3), (2.5, 3))] + ['{"filled_pixels": 3}']


class Layout:
    """Takes what a panel draws."""

    def __init__(self):
        self.labels, self.properties, self.made = [], [], {}

    def box(self):
        return self

    column = row = lambda self, align=False: self

    def menu(self, *_, **__):
        pass

    def split(self, factor):
        return self

    use_property_split = use_property_decorate = False

    def label(self, text, icon="", translate=True):
        self.labels.append(text)

    def prop(self, holder, name, text="", translate=True, emboss=True):
        assert name in holder.bl_rna.properties
        self.properties.append(name)

    def operator(self, name, text="", icon=""):
        self.made[name] = SimpleNamespace()
        return self.made[name]


def drawn(room) -> Layout:
    """The whole panel, as it is drawn at every redraw."""
    layout = Layout()
    for panel in room("addon.interface.panels").CLASSES:
        if panel.bl_space_type == "VIEW_3D" and getattr(panel, "poll", lambda _: True)(bpy.context):
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout


@pytest.fixture
def scene(blank):
    """A cube, a wall mirror and its reflection, which is active."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    parts.select(cube, parts.add_wall_mirror())
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 64, 48
    parts.generate()
    return blank.scene


def test_a_good_record_is_shown(scene, room):
    def told() -> list[str]:
        labels = drawn(room).labels
        return labels[labels.index("Against Cycles at 64 x 48") + 1:labels.index("Shows 'Box'")]
    scene.reflection_mesh.comparison = json.dumps(GOOD)
    assert told() == ["Displacement 0.050 px, 99 %: 0.250 px", "Holes, spill, wrong layer 0.500 %",
                      "SSIM 0.9900, FLIP 0.0100, PSNR 30.0 dB"]
    scene.reflection_mesh.comparison = json.dumps(GOOD | dict.fromkeys(("median", "p99", "psnr", "ssim", "flip")))
    assert told() == ["Holes, spill, wrong layer 0.500 %"]


@pytest.mark.thorough
@pytest.mark.parametrize("text", [*HOSTILE, *[json.dumps(GOOD | change) for change in SPOILT],
                                  *[json.dumps({name: value for name, value in GOOD.items() if name != missing})
                                    for missing in ("resolution", "coverage", "median", "ssim")]])
def test_a_spoilt_record_counts_as_none(scene, room, text):
    before = drawn(room)
    scene.reflection_mesh.comparison = text
    now = drawn(room)
    assert (now.labels, list(now.made)) == (before.labels, list(before.made))


@pytest.mark.thorough
@pytest.mark.parametrize("text", NOT_COUNTS)
def test_spoilt_counts_count_as_none(scene, room, text):
    result = bpy.data.objects["Mirror Reflection"]
    good = drawn(room).labels
    assert any("filled by rays" in label for label in good)
    result.reflection_mesh.counts = text
    assert drawn(room).labels == [label for label in good if "filled by rays" not in label]


@pytest.mark.parametrize("text", ["{", '{"depth": 1000000000}', '{"depth": 0}', '{"depth": "2"}'])
def test_spoilt_counts_are_compared_all_the_same(scene, tmp_path, text):
    bpy.data.objects["Mirror Reflection"].reflection_mesh.counts = text
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1) == {"FINISHED"}
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["coverage_percent"]["all"] < 1.0


@pytest.mark.parametrize("name", ["source_object", "source_face"])
@pytest.mark.parametrize("kind", [None, ("FLOAT", "FACE"), ("INT", "POINT")])
def test_a_mesh_that_lost_its_numbers_is_told(scene, tmp_path, name, kind):
    mesh = bpy.data.objects["Mirror Reflection"].data
    mesh.attributes.remove(mesh.attributes[name])
    if kind:
        mesh.attributes.new(name, *kind)
    sentence = parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path), samples=1)
    assert sentence == ("The faces of 'Mirror Reflection' do not know what they show: generate it again, "
                        "with all attributes.")


def test_a_redraw_reads_a_record_once_and_never_the_disk(scene, room, tmp_path, monkeypatch):
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    text = scene.reflection_mesh.comparison
    assert drawn(room).made["wm.url_open"].url == (tmp_path / "report.html").as_uri()

    def touched(*_, **__):
        raise AssertionError("A redraw touched the disk, or read a record again.")
    # undone before an error is told, which reads the disk itself
    with monkeypatch.context() as watched:
        for place, name in ((os, "stat"), (os, "lstat"), (os, "listdir"), (os, "scandir"), (os, "open"), (io, "open"),
                            (Path, "is_file"), (Path, "exists"), (room("addon.writing.records").json, "loads")):
            watched.setattr(place, name, touched)
        layout = drawn(room)
    assert layout.made["wm.url_open"].url.startswith("file:///")
    assert "folder" not in json.loads(text) and str(tmp_path) not in text


@pytest.mark.parametrize("folder", ["/somewhere", "//share.invalid/folder", "\\\\share.invalid\\folder", "."])
def test_a_folder_that_a_file_brings_is_not_offered(scene, room, tmp_path, folder):
    scene.reflection_mesh.comparison = json.dumps(GOOD | {"folder": str(tmp_path) if folder == "." else folder})
    (tmp_path / "report.html").write_text("mine")
    layout = drawn(room)
    assert "Against Cycles at 64 x 48" in layout.labels and "wm.url_open" not in layout.made


def test_the_page_is_offered_in_its_session_and_scene_alone(scene, room, tmp_path):
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path / "one"), samples=1)
    first = scene.reflection_mesh.comparison
    address = room("addon.comparison.show_comparison").page_address
    other = bpy.data.scenes.new("Other")
    other.reflection_mesh.comparison = first
    assert address(other) == "" and address(scene) == (tmp_path / "one" / "report.html").as_uri()
    scene.reflection_mesh.comparison = json.dumps(GOOD)
    assert address(scene) == ""
    # as undo brings it back
    scene.reflection_mesh.comparison = first
    assert address(scene) == (tmp_path / "one" / "report.html").as_uri()
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert address(bpy.context.scene) == ""
    assert "Against Cycles at 64 x 48" in drawn(room).labels


def test_the_buttons_carry_no_settings(scene, room):
    """What they run takes the file's, as every other way in does."""
    layout = drawn(room)
    assert {"tolerance", "placement", "method", "depth", "memory", "hidden_faces"} <= set(layout.properties)
    assert all(vars(made) == {} for name, made in layout.made.items())
    assert {"generate", "light", "bake", "clear", "compare"} <= {name.rpartition(".")[2] for name in layout.made}
