"""A comparison in steps: the same numbers as in one go, and no trace wherever it is stopped."""
from __future__ import annotations

import json
from pathlib import Path

import bpy
import faults
import parts
import pytest

from tests.fuzz.blender import scene_state

RENDERS = 9 if bpy.app.version >= (5, 0, 0) else 7


@pytest.fixture
def job(room):
    """Start a comparison: its steps."""
    def started(folder: Path):
        return room("addon.operators.compare").comparison(bpy.context, str(folder), 1)
    return started


@pytest.fixture
def scene(saved_scene, tmp_path):
    """A mirror and a cube, with a selection, a smooth dish as a second mirror, and a folder that holds something."""
    dish = parts.add("uv_sphere", "Dish", segments=24, ring_count=12, location=(-1.5, 0.0, 0.6), radius=0.5)
    dish.data.polygons.foreach_set("use_smooth", [True] * len(dish.data.polygons))
    dish.reflection_mesh.role = "MIRROR"
    dish.visible_glossy = False
    # as `comparison` takes it; and the stages of a second bounce would come again
    bpy.context.scene.reflection_mesh.depth = 1
    bpy.data.objects["Box"].location.x = 1.2
    bpy.context.view_layer.update()
    parts.select(bpy.data.objects["Box"])
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "report.json").write_text("old")
    (folder / "mine.txt").write_text("mine")
    return folder


def whole(folder: Path) -> tuple[dict, dict, list]:
    """All of the file and of the folder; any render leaves its result as an image."""
    found = scene_state.state()
    found["data images"] = [name for name in found["data images"] if name != "Render Result"]
    return found, faults.contents(folder.parent), sorted(path.name for path in folder.parent.rglob("*"))


def numbers(folder: Path) -> dict:
    """What report.json holds, without seconds."""
    report = json.loads((folder / "report.json").read_text())
    return {name: value for name, value in report.items() if "seconds" not in name}


def test_steps_give_the_numbers_that_one_go_gives(scene, room, job, tmp_path):
    assert bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", filepath=str(tmp_path / "one"), samples=1) == {"FINISHED"}
    bpy.ops.reflection_mesh.clear()
    steps, told = job(scene), []
    while True:
        try:
            told.append(next(steps))
        except StopIteration as stop:
            report = stop.value
            break
        # the window is drawn, and what is on the screen evaluated
        bpy.context.view_layer.update()
        bpy.context.evaluated_depsgraph_get()
    expected = numbers(tmp_path / "one")
    assert numbers(scene) == expected and expected["measured_pixels"] > 100
    assert {name: value for name, value in report.items() if "seconds" not in name} == expected
    assert set(faults.contents(scene)) == faults.RESULTS | {"mine.txt"}
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions) and fractions[0] == 0.0 and 0.95 < fractions[-1] <= 1.0
    assert all(stage for _, stage in told)
    # each render is a step that is told of as one that cannot be divided, and nothing else is
    renders = [stage for _, stage in told if isinstance(stage, room("addon.faults").Undivided)]
    assert [stage.rpartition(", ")[2] for stage in renders] == [f"{number} of {RENDERS}"
                                                               for number in range(1, RENDERS + 1)]
    assert len(set(renders)) == RENDERS and all(stage.startswith("Rendering the ") for stage in renders)
    # the generation's own steps are among them
    assert {stage.partition(":")[0] for _, stage in told} >= {"Mirror", "Dish"}


def test_a_step_is_one_render_at_most(scene, room, job, monkeypatch):
    place, count = room("addon.rendering.cycles_pictures"), []
    render = place._write_still

    def counted(copied):
        count.append(copied.name)
        render(copied)
    monkeypatch.setattr(place, "_write_still", counted)
    steps, before = job(scene), 0
    undivided = room("addon.faults").Undivided
    last = next(steps)[1]
    for _, stage in steps:
        assert len(count) - before == isinstance(last, undivided)
        before, last = len(count), stage
    assert len(count) == RENDERS


@pytest.mark.thorough
@pytest.mark.parametrize("generated", [False, True])
def test_stopped_after_any_step_it_leaves_no_trace(scene, job, generated):
    """The reflections that it makes for itself go; those that were there stay."""
    if generated:
        bpy.ops.reflection_mesh.generate(placement="VIRTUAL")
        bpy.data.objects["Mirror Reflection"].select_set(True)
        parts.select(bpy.data.objects["Dish Reflection"])
    before = whole(scene)
    told = list(dict.fromkeys(stage for _, stage in job(scene)))
    assert len(told) >= RENDERS + 6
    restore(scene, generated)
    assert_same(whole(scene), before, "restored")
    # a slow machine may tell a stage twice: each stage once is enough
    for stage in told:
        # what stands still is kept: what has changed is read again
        bpy.data.objects["Box"].data.update()
        bpy.context.view_layer.update()
        running = job(scene)
        while next(running)[1] != stage:
            pass
        running.close()
        assert_same(whole(scene), before, stage)


def restore(folder: Path, generated: bool) -> None:
    """Undo what the whole comparison has left."""
    if not generated:
        bpy.ops.reflection_mesh.clear()
    for name in faults.RESULTS:
        (folder / name).unlink()
    (folder / "report.json").write_text("old")


def assert_same(after: tuple, before: tuple, stage: str) -> None:
    assert not scene_state.differences(before[0], after[0]), stage
    assert after[0].keys() == before[0].keys() and after[1:] == before[1:], stage


def test_a_folder_that_was_made_goes_where_it_is_stopped(scene, job):
    before, folder = whole(scene), scene.parent / "deep" / "new"
    running = job(folder)
    for _ in range(3):
        next(running)
    assert folder.is_dir()
    running.close()
    assert_same(whole(scene), before, "made")


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_stopped_it_leaves_the_results_of_other_cameras_shown(scene, job, placement):
    """One that it needs itself puts them aside, and closes their windows."""
    mirror, context = bpy.data.objects["Mirror"], bpy.context
    parts.select(bpy.data.objects["Box"], mirror)
    bpy.ops.reflection_mesh.generate(placement=placement)
    first = context.scene.camera
    bpy.ops.object.camera_add(location=(1.0, -6.0, 1.0), rotation=(1.45, 0.0, 0.1))
    context.scene.camera = context.object
    parts.select(bpy.data.objects["Box"], mirror)
    context.view_layer.update()
    before = parts.state()
    running = job(scene)
    while "Copying" not in next(running)[1]:
        pass
    assert "Mirror Reflection Camera.001" in context.scene.objects
    running.close()
    context.view_layer.update()
    assert parts.state() == before and context.scene.reflection_mesh.seen_by == first


@pytest.mark.thorough
@pytest.mark.parametrize("names", [("scenes", "Reflection Comparison"), ("objects", "Copy"), ("meshes", "Cube.001"),
                                   ("materials", "Code: Identity"), ("meshes", "Mirror Reflection"),
                                   ("meshes", "Dish Reflection"), ("objects", "Mirror")])
@pytest.mark.parametrize("moment", ["first", "last", "stopped"])
def test_what_others_remove_between_two_steps_is_not_missed(scene, room, job, names, moment):
    """As from a second window: the comparison ends with one sentence, and only what was removed is gone."""
    before, kind, name = whole(scene), *names
    running = job(scene)
    wanted = RENDERS if moment == "last" else 1
    while not next(running)[1].endswith(f"{wanted} of {RENDERS}"):
        pass
    getattr(bpy.data, kind).remove(getattr(bpy.data, kind)[name])
    if moment == "stopped":
        running.close()
    else:
        try:
            list(running)
        except ReferenceError as error:
            assert "was removed" in room("addon.faults").sentence(error, "It")
        else:
            # it was not asked for any more, and the comparison has come to its end
            restore(scene, False)
    after = whole(scene)
    if name == "Mirror":
        assert "Mirror" not in bpy.data.objects and "Mirror Reflection" not in bpy.data.objects
        assert after[0]["data scenes"] == before[0]["data scenes"] and after[1:] == before[1:]
    else:
        assert_same(after, before, name)


def test_invoked_in_the_background_it_runs_to_its_end(scene):
    assert bpy.ops.reflection_mesh.compare("INVOKE_DEFAULT", samples=1) == {"FINISHED"}
    beside = Path(bpy.data.filepath).parent / "reflection comparison"
    assert set(faults.contents(beside)) == faults.RESULTS


def test_one_undo_step(scene, tmp_path):
    bpy.ops.ed.undo_push(message="Scene")
    before = parts.state()
    assert bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", True, filepath=str(tmp_path), samples=1) == {"FINISHED"}
    assert {"Mirror Reflection", "Dish Reflection"} <= set(parts.state()["objects"])
    bpy.ops.ed.undo()
    assert parts.state() == before


def test_the_command_says_each_stage_once(scene, room, tmp_path, capsys):
    assert room("addon.command_line").run(["compare", "--samples", "1", "--output", str(tmp_path / "out")]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if " %  " in line]
    stages = [line.partition(" %  ")[2] for line in lines]
    assert len(stages) == len(set(stages)) and f"{RENDERS} of {RENDERS}" in stages[-7]


@pytest.mark.parametrize("closed", [False, True])
def test_undo_between_two_steps_ends_it(scene, room, job, closed):
    """From a second window: what was copied is gone, and so are the reflections that were made."""
    bpy.ops.ed.undo_push(message="One")
    before = whole(scene)
    bpy.data.objects["Box"].location.z = 3.0
    bpy.ops.ed.undo_push(message="Two")
    running = job(scene)
    while not next(running)[1].endswith(f"3 of {RENDERS}"):
        pass
    bpy.ops.ed.undo()
    if closed:
        running.close()
    else:
        with pytest.raises(ReferenceError):
            list(running)
    assert_same(whole(scene), before, "undone")
