"""Caustics beside Cycles' own and beside rays: right numbers, a file that stays as it was, wherever it is stopped."""
from __future__ import annotations

import json

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import add_lamp, scene_of

from tests.fuzz.blender.scene_state import state

FILES = {"reference.png", "result.png", "cycles.png", "difference.png", "difference_cycles.png", "report.json",
         "report.csv", "report.html"}


@pytest.fixture
def lit(blank):
    """A patch of light on a floor by a lamp of some size, large enough that Cycles converges soon."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.25)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=4) == {"FINISHED"}
    blank.scene.cycles.transparent_max_bounces = 64
    return bpy.data.objects["Mirror Caustics"]


def compared(tmp_path, **options) -> dict:
    folder = tmp_path / "out"
    values = {"samples": 4, "converged": 64, "rays": 40_000, **options}
    assert bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", filepath=str(folder), **values) == {"FINISHED"}
    assert {path.name for path in folder.iterdir()} == FILES
    return json.loads((folder / "report.json").read_text())


def whole() -> dict:
    """The file, and what its lamps light; any render leaves its result as an image."""
    found = state() | {f"lamp {obj.name}": obj.light_linking.receiver_collection for obj in bpy.data.objects
                       if obj.type == "LIGHT"}
    found["data images"] = [name for name in found["data images"] if name != "Render Result"]
    return found


@pytest.mark.slow
def test_the_mesh_is_as_near_to_cycles_as_its_noise(lit, tmp_path):
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=16) == {"FINISHED"}
    report = compared(tmp_path, samples=8, converged=256)
    assert report["results"] == ["Mirror Caustics"] and report["lamps"] == ["Lamp"]
    last = {run["method"]: run for run in report["runs"]}
    mesh, own = (last[kind]["picture"]["receivers"]["rmse"] for kind in ("MESH", "CYCLES"))
    noise = report["reference"]["noise"]
    assert mesh < own and mesh < 2.0 * noise + 0.02
    # two pictures of other noise are as far apart as one from the converged one
    assert last["CYCLES"]["picture"]["noise"]["rmse"] == pytest.approx(own, rel=0.3)
    assert report["generate_seconds"] > 0.0


@pytest.mark.thorough
def test_a_result_with_wrong_light_is_found(lit, tmp_path):
    light = report_of(compared(tmp_path))
    assert abs(light["flux_percent"]) < max(4.0 * light["flux_noise_percent"], 0.2)
    assert light["irradiance_percent"] < 1.5 * light["irradiance_noise_percent"] + 3.0
    for name in ("irradiance", "caustic_light"):
        values = parts.attribute(lit, name) * 1.05
        lit.data.attributes[name].data.foreach_set("vector" if values.ndim > 1 else "value", values.ravel())
    assert report_of(compared(tmp_path))["flux_percent"] == pytest.approx(5.0 + 1.05 * light["flux_percent"], abs=0.01)
    lit.location.x += 0.2
    bpy.context.view_layer.update()
    moved = report_of(compared(tmp_path))
    assert moved["irradiance_percent"] > light["irradiance_percent"] + 10.0
    lit.data.attributes.remove(lit.data.attributes["irradiance"])
    assert "do not know their light" in parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path / "out"))


def report_of(report: dict) -> dict:
    return report["light"]["Mirror Caustics"]


@pytest.mark.thorough
def test_the_file_stays_as_it_was_wherever_it_is_stopped(lit, room, tmp_path):
    job, effort = room("addon.operators.compare_light").light_comparison, room("addon.operators.compare_light").Effort
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine")
    before, stages, number = whole(), [], 1
    while True:
        steps = job(bpy.context, str(tmp_path / "out"), effort(1, 8, 1000))
        told = [told for _, told in zip(range(number), steps)]
        steps.close()
        assert whole() == before
        if len(told) < number:
            break
        assert [path.name for path in (tmp_path / "out").iterdir()] == ["mine.txt"]
        stages.append(told[-1])
        number = 2 * number + 1
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions) and fractions[0] == 0.0 and 0.9 < fractions[-1] <= 1.0
    undivided = room("addon.faults").Undivided
    renders = [stage for _, stage in told if isinstance(stage, undivided)]
    assert len(renders) == 8 + 3 * 2 and renders[-1].endswith("14 of 14")
    assert (tmp_path / "out" / "report.html").exists()


@pytest.mark.thorough
def test_an_error_between_two_renders_leaves_the_file_as_it_was(lit, room, monkeypatch, tmp_path):
    pictures, before, count = room("addon.comparison.light_pictures"), whole(), []
    rendering = pictures.rendering

    def failing(scene):
        count.append(scene)
        if len(count) == 9:
            raise room("core").ReflectionError("It went wrong.")
        return rendering(scene)
    monkeypatch.setattr(pictures, "rendering", failing)
    assert "went wrong" in parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path / "out"), samples=1,
                                         converged=8, rays=1000)
    assert len(count) == 9 and whole() == before and not (tmp_path / "out").exists()


def test_selection_and_results_say_what_is_compared(lit, room):
    means = room("addon.operators.compare").means_caustics
    mirror, floor = bpy.data.objects["Mirror"], bpy.data.objects["Floor"]
    parts.select(lit)
    assert means(bpy.context)
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert means(bpy.context) and bpy.ops.reflection_mesh.compare.poll()
    parts.select(floor, mirror)
    assert means(bpy.context)
    parts.add("cube", "Box", size=0.3, location=(0.3, 0.0, 0.4))
    bpy.context.scene.camera.data.type = "PERSP"
    bpy.context.scene.camera.location, bpy.context.scene.camera.rotation_euler = (-3, -1.5, 2), (1.2, 0, -1.1)
    bpy.context.view_layer.update()
    parts.select(floor, bpy.data.objects["Box"], mirror)
    assert bpy.ops.reflection_mesh.generate() == {"FINISHED"}
    assert not means(bpy.context)
    parts.select(floor, mirror)
    assert not means(bpy.context)
    parts.select(lit)
    assert means(bpy.context)


def test_what_cannot_be_compared_is_told(lit, tmp_path):
    lit.hide_render = True
    assert "is hidden" in parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path), what="CAUSTICS")
    lit.hide_render = False
    parts.select(lit)
    bpy.ops.reflection_mesh.clear()
    parts.select(bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    assert "generate caustics first" in parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(tmp_path),
                                                      what="CAUSTICS")


@pytest.mark.thorough
def test_several_lamps_and_the_panel(lit, room, tmp_path):
    sun = add_lamp("Sun", "SUN", (-1.0, 0.3, 2.0))
    sun.data.angle = 0.3
    parts.select(bpy.data.objects["Floor"], bpy.data.objects["Lamp"], sun, bpy.data.objects["Mirror"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=2) == {"FINISHED"}
    assert len(compared(tmp_path)["light"]) == 2
    lines = room("addon.comparison.show_comparison").lines(bpy.context.scene)
    assert lines[0].startswith("Against Cycles at 64 x 64") and "Flux" in lines[-1] and len(lines) == 3
    assert room("addon.writing.records").light_comparison('{"resolution": [1, 2], "light_samples": "x"}') is None


@pytest.mark.thorough
def test_the_verb_compares_caustics(lit, room, tmp_path, capsys):
    run = room("addon.command_line.verbs").run
    assert run(["compare", "--what", "CAUSTICS", "--samples", "1", "--reference", "8", "--rays", "1000", "--output",
                str(tmp_path / "out")]) == 0
    assert "from Cycles' own converged caustics" in capsys.readouterr().out
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES
    assert run(["compare", "--reference", "0", "--output", str(tmp_path / "out")]) == 1


def test_a_bright_line_is_found_beside_its_curve(room):
    offsets = room("addon.metrics").line_offsets
    y, x = np.mgrid[0:80, 0:100] + 0.5
    middle = np.column_stack((np.full(60, 40.0), np.linspace(10.0, 70.0, 60)))
    inward, length = np.tile((1.0, 0.0), (60, 1)), np.ones(60)
    pictures = {"one": np.exp(-(x - 42.3)**2 / 2.0), "other": np.exp(-(x - 41.0)**2 / 4.0) + 0.1}
    found = offsets(pictures, middle, inward, length)
    assert np.abs(found["one"] - 2.3).max() < 0.05 and np.abs(found["other"] - 1.0).max() < 0.05
    assert len(found["one"]) > 5
    assert not len(offsets({"flat": np.ones((80, 100))}, middle, inward, length)["flat"])


def test_the_light_of_faces_is_laid_on_squares_however_large_they_are(room):
    metrics = room("addon.metrics")
    low, high = np.zeros(3), np.array((1.0, 1.0, 0.0))
    squares = metrics.Squares(low, high)
    corners = np.array([[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 0, 0), (1, 1, 0), (0, 1, 0)]], dtype=float)
    upwards = np.tile((0.0, 0.0, 1.0), (2, 1))
    # rises along x
    irradiance = 1.0 + corners[:, :, 0]
    names, flux = metrics.light_in_squares(corners, irradiance, upwards, squares)
    middle = (np.arange(128) + 0.5) / 128.0
    x, y = (one.ravel() for one in np.meshgrid(middle, middle))
    asked = squares.names(np.column_stack((x, y, 0.0 * x)), np.tile(upwards[0], (len(x), 1)))
    found = flux[np.searchsorted(names, asked)]
    assert np.array_equal(names, np.sort(asked)) and abs(flux.sum() - 1.5) < 1e-12
    assert np.abs(found * 128.0**2 / (1.0 + x) - 1.0).max() < 1e-9
