"""The benchmark: Cycles as the judge at the pixels' centres and anywhere in them, and a report that tells the truth."""
from __future__ import annotations

import csv
import json
from dataclasses import replace
from html import escape
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest

PIXELS = 96


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    names = ("benchmark", "metrics.pixel_errors", "command_line", "judge.cycles_scene", "report.report_data")
    inner = ("case", "growth", "judging", "methods", "running", "scene_report", "talk", "truth")
    names += tuple(f"benchmark.{name}" for name in inner)
    found = {name.rpartition(".")[2]: room(f"addon.{name}") for name in names}
    return SimpleNamespace(core=room("core"), rivals=room("core.rivals"), **found)


@pytest.fixture
def wall(blank):
    """A wall mirror seen head on, and behind the camera a larger wall that fills it: motion is alike in all places."""
    blank.scene.camera.rotation_euler = (np.pi / 2, 0.0, 0.0)
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = PIXELS
    plate = parts.add("plane", "Plate", size=60.0, location=(0.0, -9.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    mirror = parts.add_wall_mirror()
    mirror.reflection_mesh.role, plate.reflection_mesh.role = "MIRROR", "DIFFUSE"
    return blank


@pytest.fixture
def ball(blank):
    """A smooth ball as the mirror, over a floor and beside two boxes."""
    return with_ball(blank, 24)


@pytest.fixture
def coarse_ball(blank):
    """The same with triangles so large that each is a camera, in pictures of 64 pixels too."""
    return with_ball(blank, 8)


def with_ball(blank, rings: int):
    ball = parts.add("uv_sphere", "Ball", segments=2 * rings, ring_count=rings, radius=1.3, location=(0.0, 0.0, 1.3))
    for polygon in ball.data.polygons:
        polygon.use_smooth = True
    others = [parts.add("plane", "Floor", size=12.0), parts.add("cube", "Left", size=1.0, location=(-2.2, -1.5, 0.5)),
              parts.add("cube", "Right", size=1.2, location=(2.0, -2.0, 0.6))]
    ball.reflection_mesh.role = "MIRROR"
    for other in others:
        other.reflection_mesh.role = "DIFFUSE"
    return blank


def judged(rooms, context, pixels=None):
    """The case, what the eye sees, and the truths: a `Contest`."""
    case = rooms.case.read_case(context, pixels)
    with rooms.cycles_scene.copied_scene(context, case.mirrors, case.diffuse, []) as copied:
        truths = rooms.truth.render_truths(context, copied, case)
    return rooms.running.Contest(case, rooms.rivals.primary_hits(case.view, case.mirror, case.scene.mesh), truths)


def state() -> dict:
    """As `parts.state`, but for the image that any render leaves."""
    found = parts.state()
    found["data"]["images"] = [name for name in found["data"]["images"] if name != "Render Result"]
    return found


def made(rooms, scene, key: str, value: float):
    return rooms.methods.METHODS[key].run(scene.case, value, scene.hits)


# ---- the judge ----------------------------------------------------------------------------------------------------

def test_rays_are_exact_at_the_centres_and_a_broken_mesh_is_not(rooms, ball):
    scene = judged(rooms, ball, 128)
    rays = rooms.judging.errors(scene.case, [scene.truths.centres], made(rooms, scene, "RAYS", 1))
    assert rays["mean_error_px"] < 0.01 and rays["coverage_percent"]["all"] < 0.2
    assert len(scene.truths.centres.pixel) > 2000
    mesh = made(rooms, scene, "GENERAL", 0.5)
    # between the pixels' centres a mirror of small triangles shows what the rays beside meet
    for truths, most in (([scene.truths.centres], 0.5), (scene.truths.area, 0.8)):
        good = rooms.judging.errors(scene.case, truths, mesh)
        assert good["displacement_px"]["p99"] < most and good["mean_error_px"] < 0.15
        # a pixel to the right, which is less where the camera is nearer than the mirror's middle
        drawn = mesh.picture.mesh
        right = scene.case.view.camera_to_world[:3, 0]
        step = right @ scene.case.view.pixel_gradients(drawn.positions.T)[0]
        shifted = replace(drawn, positions=drawn.positions + right / step[:, None])
        moved = replace(mesh, picture=replace(mesh.picture, mesh=shifted))
        wrong = rooms.judging.errors(scene.case, truths, moved)
        assert wrong["mean_error_px"] > good["mean_error_px"] + 0.4
        # every tenth face dropped: holes
        kept = np.arange(len(drawn.triangles)) % 10 > 0
        cut = replace(drawn, triangles=drawn.triangles[kept], source=drawn.source[kept])
        holes = rooms.judging.errors(scene.case, truths, replace(mesh, picture=replace(mesh.picture, mesh=cut)))
        assert holes["coverage_percent"]["hole"] > good["coverage_percent"]["hole"] + 2.0
        assert holes["mean_error_px"] > good["mean_error_px"] + 0.02


def test_errors_at_the_centres_are_those_of_a_comparison(rooms, ball):
    """`measure` is the judge of the operator `compare`, tested by itself."""
    scene = judged(rooms, ball)
    picture = made(rooms, scene, "ENVIRONMENT", 64).picture
    found = rooms.judging.errors(scene.case, [scene.truths.centres], rooms.judging.Sampled(picture))
    shown, triangle = picture.triangle >= 0, np.maximum(picture.triangle, 0)
    coded = rooms.pixel_errors.CodedPicture(np.where(shown, scene.case.scene.source_object[triangle], -1),
                                               scene.case.polygon[triangle], picture.position)
    mirror, bent, truth = scene.truths.pictures
    expected = rooms.pixel_errors.measure(mirror, bent, truth, coded)
    for name in ("hole", "spill", "wrong_layer", "all"):
        assert found["coverage_percent"][name] == pytest.approx(expected.numbers["coverage_percent"][name], abs=1e-9)
    for name in ("median", "p99", "max"):
        assert found["displacement_px"][name] == pytest.approx(expected.numbers["displacement_px"][name], rel=1e-6)
    assert found["coverage_percent"]["all"] > 1.0
    displacement = expected.displacement[np.isfinite(expected.displacement)]
    wrong = sum(int(mask.sum()) for mask in (expected.hole, expected.spill, expected.wrong_layer))
    asked = len(displacement) + int(expected.hole.sum()) + int(expected.wrong_layer.sum())
    assert found["mean_error_px"] == pytest.approx((np.minimum(displacement, 1.0).sum() + wrong) / asked)


@pytest.mark.parametrize("across", [1, 2, 4])
def test_a_picture_is_as_far_off_as_its_nearest_sample(rooms, wall, across):
    """The mean distance from a square's middle is (sqrt 2 + ln(1 + sqrt 2)) / 6 of its side."""
    scene = judged(rooms, wall)
    expected = (np.sqrt(2.0) + np.log(1.0 + np.sqrt(2.0))) / 6.0 / across
    found = rooms.judging.errors(scene.case, scene.truths.area, made(rooms, scene, "RAYS", across))
    assert found["displacement_px"]["median"] == pytest.approx(np.sqrt(0.5 / np.pi) / across, rel=0.02)
    assert found["displacement_px"]["max"] == pytest.approx(np.sqrt(0.5) / across, rel=0.05)
    # on the mirror's border the nearest sample may show no mirror, or show it where there is none
    coverage = {name: share / 100.0 for name, share in found["coverage_percent"].items()}
    assert 0.0 < coverage["all"] < 0.012 and coverage["wrong_layer"] == 0.0
    assert found["mean_error_px"] == pytest.approx((1.0 - coverage["hole"]) * expected + coverage["all"], rel=0.02)
    # a flat mirror's mesh is exact everywhere
    exact = rooms.judging.errors(scene.case, scene.truths.area, made(rooms, scene, "GENERAL", 2.0))
    assert exact["mean_error_px"] < 0.002


@pytest.mark.parametrize("orthographic", [0.0, 3.0])
def test_lattices_lie_where_their_rays_go(rooms, orthographic):
    core = rooms.core
    view, other = (core.View.looking_at((1.0, -4.0, 2.0), (0.0, 0.0, 0.0), size, orthographic_scale=orthographic)
                   for size in ((96, 64), (67, 45)))
    shift = other.projection.copy()
    shift[:2] += 0.013 * shift[3]
    other = replace(other, projection=shift)
    columns, rows = rooms.truth.lattice_in(view, other)
    origins, directions = other.rays(np.stack((np.arange(40) + 0.5, np.arange(40) + 0.5), axis=1))
    np.testing.assert_allclose(view.pixels(origins + 3.0 * directions), np.stack((columns[:40], rows[:40]), axis=1),
                               atol=1e-9)


def test_places_lie_everywhere_in_the_pixels(rooms, ball):
    scene = judged(rooms, ball)
    area = scene.truths.area
    for places in (np.concatenate([getattr(truth, axis) for truth in area]) for axis in ("columns", "rows")):
        tenths = np.bincount((places % 1.0 * 10.0).astype(int), minlength=10) / len(places)
        assert tenths.min() > 0.05 and tenths.max() < 0.15
    for size in ((1024, 1024), (1920, 1080), (64, 47), (3, 2)):
        coarse = rooms.truth.coarser(size)
        assert all(np.gcd(a, b) == 1 for a, b in zip(size, coarse))


# ---- running ------------------------------------------------------------------------------------------------------

def test_what_is_expected_to_take_too_long_is_left_out_and_said(rooms, wall):
    scene = judged(rooms, wall)
    method = rooms.methods.METHODS["GENERAL"]
    runs, said = rooms.running.run_method(scene, "GENERAL", method, 0.0)
    assert [run.value for run in runs] == [method.values[0]]
    assert len(said) == 1 and "1, 0.5, 0.25 left out" in said[0] and method.title in said[0]
    runs, said = rooms.running.run_method(scene, "GENERAL", method, 600.0)
    assert [run.value for run in runs] == list(method.values) and not said


def test_a_method_that_refuses_is_left_out_and_said(rooms, wall):
    scene = judged(rooms, wall)

    def refuse(case, value, hits):
        raise rooms.core.ReflectionError("It cannot do this.")
    method = replace(rooms.methods.METHODS["RAYS"], run=refuse)
    runs, said = rooms.running.run_method(scene, "RAYS", method, 9.0)
    assert not runs and len(said) == 1 and "It cannot do this." in said[0]


@pytest.mark.thorough
def test_finer_places_seen_by_the_eye_are_paid_for(rooms, ball):
    scene = judged(rooms, ball)
    free = replace(scene.hits, seconds={"drawing": 0.0})
    for key in ("RAYS", "CLUSTERS", "BVHTREE"):
        method = rooms.methods.METHODS[key]
        assert rooms.methods.EYE not in method.run(scene.case, 1, free).picture.seconds
        finer = method.run(scene.case, 2, free)
        assert finer.picture.seconds[rooms.methods.EYE] > 0.0
        assert finer.picture.triangle.shape == tuple(2 * side for side in scene.truths.centres.view.resolution[::-1])
        assert finer.picture.counts["rays"] > 3.5 * len(scene.hits.pixel)


# ---- the report ---------------------------------------------------------------------------------------------------

def run(rooms, *arguments) -> int:
    return rooms.command_line.run(["benchmark", "--no-work", "--samples", "1", *map(str, arguments)])


@pytest.mark.thorough
def test_the_report_agrees_with_itself(rooms, coarse_ball, tmp_path, capsys):
    before = state()
    assert run(rooms, "--output", tmp_path, "--resolution", 64, "--methods", "GENERAL", "RAYS", "ENVIRONMENT") == 0
    assert state() == before
    assert "General three-ray camera, refined" in capsys.readouterr().out
    report = json.loads((tmp_path / "report.json").read_text())
    scene, = report["scenes"]
    with open(tmp_path / "report.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(scene["runs"]) == 4 + 6 + 4
    for row, told in zip(rows, scene["runs"]):
        assert (row["method"], float(row["value"])) == (told["method"], told["value"])
        assert float(row["seconds.total"]) == pytest.approx(sum(told["seconds"].values()))
        assert float(row["area.mean_error_px"]) == told["numbers"]["area"]["mean_error_px"]
    # nothing else is as good in both: by brute force, from the table
    for measure, column in (("area", "area.mean_error_px"), ("centres", "mean_error_px")):
        points = [(float(row["seconds.total"]), max(float(row[column]), 0.001)) for row in rows]
        for point, row in zip(points, rows):
            beaten = any(other[0] <= point[0] and other[1] <= point[1] and other != point for other in points)
            assert row[f"on_front.{measure}"] == str(not beaten)
    by = {(row["method"], float(row["value"])): row for row in rows}
    assert float(by["RAYS", 1.0]["mean_error_px"]) < 0.02 < float(by["GENERAL", 0.5]["mean_error_px"])
    assert float(by["GENERAL", 0.5]["area.mean_error_px"]) < float(by["RAYS", 1.0]["area.mean_error_px"])
    page = (tmp_path / "report.html").read_text()
    assert escape(scene["summary"][0]) in page and "http" not in page.replace("http://www.w3.org/2000/svg", "")
    for name in ("reference", "result", "difference", "displacement", "holes"):
        assert (tmp_path / f"{name}.png").stat().st_size > 100
    assert len(list((tmp_path / "plots").glob("*_area_mean_error_px.svg"))) == 1


def test_nothing_stays_behind_after_an_error(rooms, ball, tmp_path, monkeypatch, capsys):
    before = state()

    def fail(*_, **__):
        raise rooms.core.ReflectionError("Enough.")
    monkeypatch.setattr(rooms.scene_report, "run_method", fail)
    assert run(rooms, "--output", tmp_path, "--resolution", 48) == 1
    assert "Error: Enough." in capsys.readouterr().err and state() == before


@pytest.mark.parametrize(("arguments", "words"), [
    (["--methods", "MAGIC"], "no method 'MAGIC'"), (["--budget", "-1"], "budget"), (["--samples", "0"], "sample"),
    (["--resolution", "2"], "pixels"), (["--scenes", "nowhere.blend"], "nowhere.blend"),
])
def test_wrong_arguments_are_one_line(rooms, wall, tmp_path, capsys, arguments, words):
    assert rooms.command_line.run(["benchmark", "--output", str(tmp_path), *arguments]) == 1
    error = capsys.readouterr().err
    assert words in error and error.startswith("Error: ") and "Traceback" not in error


def test_without_a_mirror_or_a_folder_there_is_no_benchmark(rooms, wall, tmp_path, capsys):
    assert rooms.command_line.run(["benchmark"]) == 1
    assert "no folder" in capsys.readouterr().err
    bpy.data.objects["Mirror"].reflection_mesh.role = "IGNORE"
    assert run(rooms, "--output", tmp_path) == 1
    assert "mirror" in capsys.readouterr().err


@pytest.mark.thorough
def test_several_mirrors_are_one(rooms, ball, tmp_path):
    wall = parts.add_wall_mirror("Wall")
    wall.location = (0.0, 3.0, 2.0)
    wall.reflection_mesh.role = "MIRROR"
    bpy.context.view_layer.update()
    options = rooms.benchmark.Options(("GENERAL", "RAYS"), 60.0, 64, 1, tell=lambda line: None)
    scene = rooms.benchmark.scene_report(bpy.context, "two", str(tmp_path), options)
    assert "taken as one mesh" in scene.facts["objects"] and "Wall" in scene.facts["objects"]
    found = {(run.method, run.value): run.numbers for run in scene.runs}
    assert found["RAYS", 1.0]["mean_error_px"] < 0.02
    assert found["GENERAL", 0.5]["displacement_px"]["p99"] < 0.5
    assert found["GENERAL", 0.5]["coverage_percent"]["all"] < 0.5


@pytest.mark.thorough
def test_one_report_of_several_files(rooms, wall, tmp_path):
    files = [str(tmp_path / f"{name}.blend") for name in ("one", "two")]
    for path in files:
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    assert run(rooms, "--output", tmp_path / "out", "--methods", "ENVIRONMENT", "--resolution", 32, "--scenes",
               *files) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert [scene["name"] for scene in report["scenes"]] == ["one", "two"]
    assert (tmp_path / "out" / "two" / "holes.png").exists()


# ---- growth and work ----------------------------------------------------------------------------------------------

def test_growth_stops_where_a_point_takes_too_long(rooms):
    lines, said = rooms.growth.growths(0.0, lambda line: None, ((300, 600), (50, 200)), 32)
    assert {line.axis for line in lines} == {"diffuse vertices", "mirror triangles"}
    assert all(len(line.sizes) == 1 and line.seconds[0] > 0.0 for line in lines)
    assert all("more than 0 s" in sentence for sentence in said) and len(said) >= len(lines) / 2


def test_counts_are_those_that_the_talk_predicts(rooms):
    """The talk sets as many pixels; the counts of rays grow with them, those of the three-ray cameras do not."""
    found, setting = rooms.talk.costs(128)
    counted = {cost.method: cost.measured for cost in found}
    assert f"{128 * 128:,} pixels" in setting
    assert counted["RAYS"]["Tt"] == 128 * 128 and 128 * 128 < counted["RAYS"]["Ti"] < 4 * 128 * 128
    assert 1_000 < counted["UNREFINED"]["Tt"] < 2_000 < counted["UNREFINED"]["Tp"] < 4_000
    assert all(cost.explanation and cost.predicted for cost in found)
