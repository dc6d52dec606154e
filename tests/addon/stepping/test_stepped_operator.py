"""Operators in a window, with stand-ins for it: what is shown before which step, ESC, errors, and the file browser."""
from __future__ import annotations

from pathlib import Path
from types import FunctionType, SimpleNamespace

import bpy
import pytest

TIMER, ESC, MOVED = (SimpleNamespace(type=kind, value="PRESS") for kind in ("TIMER", "ESC", "MOUSEMOVE"))


class Window:
    """A context, its window manager and its workspace in one: notes what an operator does to them, in order."""

    def __init__(self, notes: list) -> None:
        self.notes, self.window = notes, object()
        self.window_manager = self.workspace = self

    def event_timer_add(self, interval, window):
        self.notes.append("timer")
        return "the timer"

    def event_timer_remove(self, timer):
        assert timer == "the timer"
        self.notes.append("no timer")

    def progress_begin(self, low, high):
        assert (low, high) == (0, 100)
        self.at_cursor = [0.0]

    def progress_update(self, value):
        assert self.at_cursor[-1] <= value <= 100.0
        self.at_cursor.append(value)

    def progress_end(self):
        self.at_cursor.append(None)

    def modal_handler_add(self, operator):
        self.notes.append("modal")

    def fileselect_add(self, operator):
        self.notes.append("browser")

    def status_text_set(self, draw):
        """As Blender: what is given draws the status bar, until None is."""
        if draw is None:
            self.notes.append("nothing shown")
            return
        # Blender calls nothing else that can be called
        assert isinstance(draw, FunctionType)
        header = Header()
        draw(header, self)
        self.notes.append("shown " + ", ".join(header.drawn))


class Header:
    """A status bar and its layout in one: notes what is drawn on it."""

    def __init__(self) -> None:
        self.drawn, self.layout = [], self

    def row(self):
        return self

    def progress(self, factor, text, translate):
        assert text == f"{100.0 * factor:.0f} %"
        self.drawn.append(text)

    def label(self, text, icon="NONE", translate=True):
        self.drawn.append(text)

    def separator_spacer(self):
        pass


class Properties:
    """Those of an operator that writes to a folder beside the open file, unless it is given another one."""

    bl_rna = SimpleNamespace(properties={"filepath": SimpleNamespace(default="//frames")})

    def __init__(self, *given: str) -> None:
        self.given = given

    def is_property_set(self, name: str, ghost: bool = True) -> bool:
        # what is remembered from the last time, maybe of another file, counts as set but for `ghost=False`
        return ghost or name in self.given


@pytest.fixture
def place(room, monkeypatch):
    """The module of stepped operators, as if there were a window."""
    module = room("addon.faults.stepped_operator")
    monkeypatch.setattr(module, "bpy", SimpleNamespace(app=SimpleNamespace(background=False), path=bpy.path,
                                                       data=SimpleNamespace(filepath="")))
    return module


def started(place, told: list, kind: str = "SteppedOperator", error: Exception | None = None):
    """An operator of three quick steps and one that cannot be divided, its window, and all that happens."""
    notes: list = []

    class Job(getattr(place, kind)):
        bl_label = "Job"
        properties, filepath = Properties(), ""

        def steps(self, context):
            try:
                for number, stage in enumerate(told):
                    notes.append(f"before {stage}")
                    yield number / len(told), stage
                    notes.append(f"after {stage}")
                if error is not None:
                    raise error
            finally:
                notes.append("cleaned up")

        def report(self, kinds, text):
            notes.append(f"{min(kinds)}: {text}")
    return Job(), Window(notes), notes


def test_what_cannot_be_divided_is_shown_before_it_begins(place):
    job, window, notes = started(place, ["one", "two", place.Undivided("whole"), "three"])
    assert job.invoke(window, None) == {"RUNNING_MODAL"}
    assert notes[-1] == "shown 0 %, one, ESC: Cancel" and {"timer", "modal"} <= set(notes)
    assert job.modal(window, TIMER) == {"RUNNING_MODAL"}
    # the quick ones in one go, and not the one that takes long
    assert notes[-1] == "shown 50 %, whole, ESC: Cancel After This Step"
    assert "after two" in notes and "after whole" not in notes
    assert job.modal(window, MOVED) == {"RUNNING_MODAL"} and notes[-1].startswith("shown 50 %, whole")
    assert job.modal(window, TIMER) == {"FINISHED"}
    # per cent, and nothing afterwards
    assert window.at_cursor[1:3] == [0.0, 50.0] and window.at_cursor[-1] is None
    assert notes[-3:] == ["cleaned up", "no timer", "nothing shown"]


def test_esc_stops_before_what_was_shown(place):
    job, window, notes = started(place, ["one", place.Undivided("whole"), "two"])
    job.invoke(window, None)
    job.modal(window, TIMER)
    assert job.modal(window, SimpleNamespace(type="ESC", value="RELEASE")) == {"RUNNING_MODAL"}
    assert job.modal(window, ESC) == {"CANCELLED"}
    assert notes[-4:] == ["cleaned up", "no timer", "nothing shown", "INFO: Job: cancelled, nothing has changed."]
    assert "after whole" not in notes


def test_an_error_in_a_step_is_told_and_the_window_tidied(place):
    job, window, notes = started(place, [place.Undivided("whole")], error=ReferenceError("gone"))
    job.invoke(window, None)
    assert job.modal(window, TIMER) == {"CANCELLED"}
    assert notes[-4:] == ["cleaned up", "ERROR: An object was removed while the work went on: start it again.",
                          "no timer", "nothing shown"]


def test_what_is_wrong_at_once_changes_nothing_in_the_window(place):
    job, window, notes = started(place, [], error=ReferenceError("gone"))
    assert job.invoke(window, None) == {"CANCELLED"}
    assert "timer" not in notes and "modal" not in notes


def test_the_file_browser_comes_first_and_calls_execute(place):
    job, window, notes = started(place, ["one", "two"], "BrowsingOperator")
    assert job.invoke(window, None) == {"RUNNING_MODAL"} and notes == ["browser"]
    # the browser was closed
    job.cancel(window)
    assert notes == ["browser"]
    assert job.execute(window) == {"RUNNING_MODAL"}
    assert "after one" not in notes and "modal" in notes
    assert job.modal(window, TIMER) == {"FINISHED"} and notes[-1] == "nothing shown"
    # done again with other settings, without a browser: in one go
    notes.clear()
    assert job.execute(window) == {"FINISHED"} and "timer" not in notes and "browser" not in notes


def test_the_browser_begins_with_the_operators_own_place(place, tmp_path):
    """Blender would propose the open file's name, as the name of a folder even."""
    job, window, _ = started(place, ["one"], "BrowsingOperator")
    job.invoke(window, None)
    assert job.filepath == "frames"
    job, window, _ = started(place, ["one"], "BrowsingOperator")
    job.properties, job.filepath = Properties("filepath"), "/elsewhere"
    job.invoke(window, None)
    assert job.filepath == "/elsewhere"


def test_places_beside_the_open_file(blank, room, tmp_path):
    proposed = room("addon.faults.stepped_operator").proposed
    assert proposed("//sheet.png") == "sheet.png"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "mine.blend"))
    assert Path(proposed("//sheet.png")) == tmp_path / "sheet.png"
    for operator in ("bake", "compare", "print_sheet"):
        kind = getattr(bpy.ops.reflection_mesh, operator).get_rna_type()
        assert kind.properties["filepath"].default.startswith("//")


def test_executed_or_without_a_window_it_runs_to_its_end(place):
    for kind in ("SteppedOperator", "BrowsingOperator"):
        job, window, notes = started(place, ["one", place.Undivided("whole")], kind)
        assert job.execute(window) == {"FINISHED"}
        window.window = None
        assert job.invoke(window, None) == {"FINISHED"}
        assert notes.count("after whole") == 2 and "timer" not in notes and "browser" not in notes


@pytest.mark.parametrize(("passed", "fraction", "told"), [
    (0.5, 0.5, ""), (60.0, 0.01, ""), (10.0, 0.25, "about 30 s left"), (9.0, 0.999, "about 1 s left"),
    (60.0, 0.2, "about 4 min left"), (3600.0, 0.25, "about 3.0 h left")])
def test_time_left(room, passed, fraction, told):
    assert room("addon.faults.status_bar").time_left(passed, fraction) == told


def test_blender_has_what_the_status_bar_draws(room, monkeypatch):
    # layouts exist in windows only: their functions by Blender's own description of them
    functions = bpy.types.UILayout.bl_rna.functions
    assert {"factor", "text", "translate"} <= set(functions["progress"].parameters.keys())
    assert {"label", "row", "separator_spacer"} <= set(functions.keys())
    icons = functions["label"].parameters["icon"].enum_items.keys()
    assert "TIME" in icons
