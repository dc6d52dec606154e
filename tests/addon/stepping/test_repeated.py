"""Operators that Blender repeats start again with progress and ESC, and never run within the call that repeats them."""
from __future__ import annotations

import inspect
from contextlib import nullcontext
from types import SimpleNamespace

import bpy
import pytest
from test_stepped_operator import Window, started


class Timers:
    """Blender's timers, of which one runs when it is asked to."""

    def __init__(self) -> None:
        self.waiting: list = []

    def register(self, function, first_interval):
        self.waiting.append(function)

    def unregister(self, function):
        self.waiting.remove(function)

    def is_registered(self, function):
        return function in self.waiting

    def run(self):
        function, = self.waiting
        again = function()
        if again is None and function in self.waiting:
            self.waiting.remove(function)
        return again


@pytest.fixture
def repeated(room, monkeypatch):
    """An operator as Blender repeats it in a window: its module, its timers, what is invoked and what pops up."""
    place, again = room("addon.faults.stepped_operator"), room("addon.faults.again")
    window = SimpleNamespace(modal_operators=[], as_pointer=lambda: 42)
    seen = SimpleNamespace(timers=Timers(), invoked=[], popups=[], window=window, place=place, error=None, again=again)

    def invoked(*how, **given):
        seen.invoked.append((how, given, again.starts_again()))
        if seen.error:
            raise RuntimeError(seen.error)
    manager = SimpleNamespace(windows=[window], popup_menu=lambda draw, title, icon: seen.popups.append((draw, icon)))
    monkeypatch.setattr(again, "bpy", SimpleNamespace(
        app=SimpleNamespace(background=False, timers=seen.timers), types=bpy.types,
        context=SimpleNamespace(window_manager=manager, temp_override=lambda window: nullcontext()),
        ops=SimpleNamespace(reflection_mesh=SimpleNamespace(job=invoked))))
    monkeypatch.setattr(place, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    return seen


def job_of(seen, kind="SteppedOperator", **options):
    job, window, notes = started(seen.place, ["one", "two"], kind)
    window.window = seen.window
    job.bl_idname = "REFLECTION_MESH_OT_job"
    job.options = SimpleNamespace(**{"is_repeat": False, "is_repeat_last": False, **options})
    job.samples, job.kind = 8, "AUTO"

    class Given:
        bl_rna = SimpleNamespace(properties={"rna_type": None, "samples": None, "kind": None,
                                             "filepath": SimpleNamespace(default="//frames")})
        samples, kind = 8, "AUTO"

        def is_property_set(self, name, ghost=True):
            return name == "samples"
    job.properties = Given()
    return job, window, notes


@pytest.mark.parametrize("kind", ["SteppedOperator", "BrowsingOperator"])
@pytest.mark.parametrize("how", ["is_repeat", "is_repeat_last"])
def test_it_is_invoked_by_a_timer(repeated, kind, how):
    job, window, notes = job_of(repeated, kind, **{how: True})
    # as while a value is dragged: the last one counts
    for samples in (3, 5, 8):
        job.properties.samples = samples
        assert job.execute(window) == {"CANCELLED"} and notes == []
    assert repeated.timers.run() is None and not repeated.timers.waiting
    assert repeated.invoked == [(("INVOKE_DEFAULT", True), {"samples": 8}, True)] and not repeated.again.starts_again()


def test_it_waits_for_other_operators(repeated):
    job, window, _ = job_of(repeated, is_repeat=True)
    job.execute(window)
    repeated.window.modal_operators.append("grab")
    assert 0.0 < repeated.timers.run() < 1.0 and repeated.invoked == []
    repeated.window.modal_operators.clear()
    assert repeated.timers.run() is None and len(repeated.invoked) == 1


def test_what_keeps_it_from_starting_pops_up(repeated):
    job, window, _ = job_of(repeated, is_repeat=True)
    job.execute(window)
    repeated.error = "Error: The memory is too small: raise it.\n"
    repeated.timers.run()
    (draw, icon), = repeated.popups
    lines: list = []
    draw(SimpleNamespace(layout=SimpleNamespace(label=lambda text, translate: lines.append(text))), None)
    assert lines == ["The memory is too small: raise it."] and icon == "ERROR" and not repeated.again.starts_again()


def test_a_script_runs_it_to_its_end(repeated):
    job, window, notes = job_of(repeated)
    assert job.execute(window) == {"FINISHED"} and notes[-1] == "cleaned up" and not repeated.timers.waiting
    # how far it is, is seen at the cursor, and nothing afterwards
    assert window.at_cursor == [0.0, 0.0, 50.0, None]


def test_its_file_browser_does_not_open_again(repeated, monkeypatch):
    monkeypatch.setattr(repeated.again, "_starting", [True])
    job, window, notes = job_of(repeated, "BrowsingOperator")
    assert job.invoke(window, None) == {"RUNNING_MODAL"} and "browser" not in notes and "modal" in notes
    job.cancel(window)


def test_every_operator_that_works_in_steps_can_be_repeated_so(room):
    """None has an `execute` of its own beside the one that knows of repetition, but those that take no time."""
    faults = room("addon.faults")
    operators = [cls for cls in bpy.types.Operator.__subclasses__() if cls.is_registered and cls.__module__.startswith(
        faults.__package__.rpartition(".")[0])]
    assert {cls.bl_idname for cls in operators if not issubclass(cls, faults.SteppedOperator)} <= {
        "reflection_mesh.clear", "reflection_mesh.live", "reflection_mesh.preset_add", "reflection_mesh.select",
        "reflection_mesh.make_mirror"}
    stepped = [cls for cls in operators if issubclass(cls, faults.SteppedOperator)]
    known = {faults.SteppedOperator.execute, faults.BrowsingOperator.execute}
    assert len(stepped) >= 7 and all(inspect.unwrap(cls.execute) in known for cls in stepped)


def test_nothing_is_judged_between_two_steps(repeated, room):
    """For which the file may have been changed for a while."""
    between, answers = room("addon.faults.between_events"), room("addon.freshness.answers")
    obj, asked = SimpleNamespace(session_uid=-5), []

    def asks(text: str) -> str:
        return answers.answer(lambda context, obj: asked.append(text) or text, None, obj, (text,))
    assert asks("before") == "before"
    job, window, _ = job_of(repeated)
    job.invoke(window, None)
    assert between.work_waits() and asks("false") == "before" and asked == ["before"]
    with between.steps_taken(apart=True):
        assert asks("true") == "true"
    job.cancel(window)
    assert not between.work_waits() and asks("after") == "after"
    assert isinstance(window, Window)
