"""Errors that nobody foresaw: one sentence, the traceback on the console, and a file that is as it was."""
from __future__ import annotations

from contextlib import contextmanager

import bpy
import numpy as np
import parts
import pytest

KINDS = ("objects", "meshes", "materials", "node_groups", "scenes", "collections")


class Halted(BaseException):
    """What is no Exception goes through every door."""


@pytest.fixture
def scene(blank):
    """A wall mirror, a floor mirror and a cube, all selected, with roles."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Red"))
    mirrors = parts.add_wall_mirror(), parts.add("plane", "Low", size=8.0)
    cube.reflection_mesh.role = "DIFFUSE"
    for mirror in mirrors:
        mirror.reflection_mesh.role = "MIRROR"
    parts.select(cube, *mirrors)
    return (*mirrors, cube)


def fingerprint() -> dict:
    """All that writing a result may touch, to the last bit; what Blender calls a mesh, but not which one it is."""
    found = {"state": parts.state(), "counts": {kind: len(getattr(bpy.data, kind)) for kind in KINDS}}
    for obj in bpy.data.objects:
        record = obj.reflection_mesh
        found[obj.name] = (
            [tuple(getattr(obj, name)) for name in ("location", "rotation_euler", "scale")], record.role, record.mirror,
            [source.object for source in record.sources], record.counts, record.estimated_error, record.seconds,
            tuple(record.resolution), record.faces, record.points, record.camera_hidden, obj.visible_camera,
            [(modifier.name, modifier.node_group and modifier.node_group.name) for modifier in obj.modifiers],
            [collection.name for collection in obj.users_collection])
        if obj.type == "MESH":
            found[obj.name, "mesh"] = (
                obj.data.name, obj.data.users, [material and material.name for material in obj.data.materials],
                {entry.name: values(entry) for entry in obj.data.attributes})
    return found


def values(entry) -> bytes:
    field, width, kind = {"FLOAT_VECTOR": ("vector", 3, "f4"), "FLOAT2": ("vector", 2, "f4"),
                          "FLOAT_COLOR": ("color", 4, "f4"), "BYTE_COLOR": ("color", 4, "f4"),
                          "QUATERNION": ("value", 4, "f4"), "INT": ("value", 1, "i4"), "FLOAT": ("value", 1, "f4"),
                          "BOOLEAN": ("value", 1, "?"), "INT32_2D": ("value", 2, "i4")}[entry.data_type]
    found = np.empty(len(entry.data) * width, dtype=kind)
    entry.data.foreach_get(field, found)
    return found.tobytes()


def fails(*_, **__):
    raise ZeroDivisionError("a number\nis zero.")


def sentence_of(operator, capfd, **options) -> str:
    capfd.readouterr()
    sentence = parts.refusal(operator, **options)
    assert "Traceback" in capfd.readouterr().err
    assert "not foreseen (ZeroDivisionError: a number is zero): nothing has changed" in sentence
    return sentence


# ---- one door -----------------------------------------------------------------------------------------------------

LABELS = {"generate": "Generate Reflection", "compare": "Compare with Cycles", "clear": "Clear Reflections"}


@pytest.mark.thorough
@pytest.mark.parametrize("failing", [
    ("generate", "operators.generate", "read_view"),
    ("generate", "operators.generate", "choose"),
    ("generate", "writing.write_object", "write_mesh"),
    ("compare", "operators.compare", "measure"),
    ("compare", "operators.compare", "write_report"),
    ("compare", "operators.compare", "participants"),
    ("clear", "operators.clear", "chosen_results"),
    ("clear", "operators.clear", "clear"),
])
def test_an_operator_says_one_sentence(scene, room, monkeypatch, capfd, tmp_path, failing):
    verb, place, name = failing
    if verb == "clear":
        parts.generate()
    before = fingerprint()
    monkeypatch.setattr(room(f"addon.{place}"), name, fails)
    options = {"filepath": str(tmp_path / "new"), "samples": 1} if verb == "compare" else {}
    assert sentence_of(getattr(bpy.ops.reflection_mesh, verb), capfd, **options).startswith(f"{LABELS[verb]} failed")
    assert fingerprint() == before and not list(tmp_path.iterdir())


def test_a_long_error_is_cut_and_an_empty_one_is_named(room):
    sentence = room("addon.faults.unforeseen").sentence
    assert len(sentence(KeyError("x" * 10_000), "It")) < 400
    assert "(RuntimeError)" in sentence(RuntimeError(), "It")


@pytest.mark.thorough
@pytest.mark.parametrize("verb", ["generate", "compare", "benchmark"])
def test_the_command_line_says_one_sentence(scene, room, monkeypatch, capsys, tmp_path, verb):
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    before = path.read_bytes()
    place, name = {"generate": ("operators.generate", "read_view"), "compare": ("operators.compare", "measure"),
                   "benchmark": ("benchmark.scene_report", "render_truths")}[verb]
    monkeypatch.setattr(room(f"addon.{place}"), name, fails)
    output = ["--output", str(tmp_path / "out")] if verb != "generate" else []
    assert room("addon.command_line").run([verb, *output]) == 1
    error = capsys.readouterr().err
    told = [line for line in error.splitlines() if line.startswith("Error: ")]
    assert len(told) == 1 and "Traceback" in error and told[0].endswith("the console tells more.")
    assert f"'{verb}' failed for a reason that was not foreseen (ZeroDivisionError: a number is zero)" in told[0]
    assert "nothing has been saved" in told[0]
    assert path.read_bytes() == before and [entry.name for entry in tmp_path.iterdir()] == ["scene.blend"]


def test_ctrl_c_ends_the_command_line_in_one_sentence(scene, room, monkeypatch, capsys, tmp_path):
    def interrupt(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(room("addon.operators.generate"), "read_view", interrupt)
    before = fingerprint()
    assert room("addon.command_line").run(["generate", "--output", str(tmp_path / "x.blend")]) == 130
    assert capsys.readouterr().err == "Interrupted: nothing has been saved.\n"
    assert fingerprint() == before and not list(tmp_path.iterdir())


def test_what_is_no_exception_passes(scene, room, monkeypatch, tmp_path):
    def halt(*_):
        raise Halted
    monkeypatch.setattr(room("addon.operators.generate"), "read_view", halt)
    for work in (lambda: room("addon.command_line").run(["generate", "--output", str(tmp_path / "x.blend")]),
                 lambda: list(started(room))):
        with pytest.raises(Halted):
            work()


# ---- all results, or none -----------------------------------------------------------------------------------------

def started(room, **settings):
    chosen = room("addon.reading.roles").choose(bpy.context)
    return room("addon.operators.generate").generation(bpy.context, chosen, room("core").Settings(**settings))


@pytest.fixture
def second_fails(room):
    """Within it the second call of one step of writing fails: before it has done its work, or, `late`, behind it."""
    place = room("addon.writing.write_object")

    @contextmanager
    def failing(name: str, late: bool, error: BaseException):
        count, work = [], getattr(place, name)

        def broken(*arguments):
            count.append(name)
            if len(count) == 2 and not late:
                raise error
            made = work(*arguments)
            if len(count) == 2:
                raise error
            return made
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(place, name, broken)
            yield
    return failing


STEPS = [("write_mesh", "GENERAL"), ("_remember", "GENERAL"), ("_remember", "POINTS"), ("write_mesh", "POINTS"),
         ("show_discs", "POINTS")]


@pytest.mark.thorough
@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("step", [*STEPS, ("new_beside", "GENERAL")])
def test_new_results_go_where_the_second_fails(scene, capfd, second_fails, step, late):
    (name, method), before = step, fingerprint()
    with second_fails(name, late, ZeroDivisionError("a number is zero")):
        sentence_of(bpy.ops.reflection_mesh.generate, capfd, method=method, placement="VIRTUAL")
    assert fingerprint() == before


@pytest.mark.thorough
@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("earlier", ["GENERAL", "POINTS"])
@pytest.mark.parametrize("step", STEPS)
def test_earlier_results_come_back_where_the_second_fails(scene, capfd, second_fails, step, earlier, late):
    name, method = step
    parts.generate(method=earlier, placement="VIRTUAL")
    results = [bpy.data.objects[f"{mirror.name} Reflection"] for mirror in scene[:2]]
    results[0].data["mine"] = 7
    results[0].rotation_euler.z, results[0].reflection_mesh.seconds = 0.3, 12.5
    scene[2].location.x = 0.4
    bpy.context.view_layer.update()
    parts.select(scene[2], *scene[:2])
    before = fingerprint()
    with second_fails(name, late, ZeroDivisionError("a number is zero")):
        sentence_of(bpy.ops.reflection_mesh.generate, capfd, method=method, placement="SURFACE")
    assert fingerprint() == before and results[0].data["mine"] == 7
    # and what came back is as good as it was
    parts.generate(method=method, placement="SURFACE")
    assert results[0].reflection_mesh.seconds < 12.5
    assert {kind: len(getattr(bpy.data, kind)) for kind in KINDS} == {
        **before["counts"], "node_groups": 2 * (method == "POINTS")}


@pytest.mark.parametrize("late", [False, True])
def test_a_mesh_that_others_show_comes_back(scene, room, second_fails, late):
    shared = parts.generate().data
    for mirror in scene[:2]:
        other = bpy.data.objects.new("Other", bpy.data.objects[f"{mirror.name} Reflection"].data)
        bpy.context.scene.collection.objects.link(other)
    parts.select(scene[2], *scene[:2])
    before = fingerprint()
    with second_fails("write_mesh", late, Halted()), pytest.raises(Halted):
        list(started(room))
    assert fingerprint() == before
    assert bpy.data.objects["Low Reflection"].data == shared


def test_success_leaves_nothing_over(scene):
    """The same mesh, updated, and no more data than the first time, however often and however the method changes."""
    for method in ("GENERAL", "GENERAL", "POINTS", "POINTS", "GENERAL"):
        parts.select(scene[2], *scene[:2])
        result = parts.generate(method=method)
        mesh = result.data
        assert (len(bpy.data.meshes), len(bpy.data.objects)) == (5, 6)
        assert len(bpy.data.node_groups) == (2 if method == "POINTS" else 0)
        parts.select(scene[2], *scene[:2])
        assert parts.generate(method=method).data == mesh
    bpy.ops.reflection_mesh.clear()
    assert (len(bpy.data.meshes), len(bpy.data.node_groups), len(bpy.data.materials)) == (3, 0, 1)


def test_a_result_that_is_no_mesh_any_more_is_let_be(scene):
    """A file may call anything a result."""
    empty = bpy.data.objects.new("Mirror Reflection", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.reflection_mesh.role, empty.reflection_mesh.mirror = "REFLECTION", scene[0]
    parts.select(scene[2], scene[0])
    assert parts.generate().name == "Mirror Reflection.001"
    bpy.ops.reflection_mesh.clear()
    parts.select()
    bpy.ops.reflection_mesh.clear()
    assert [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"] == []
