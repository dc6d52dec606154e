"""A long operator as one generator: run to its end when a script executes it, else stepped by a timer, with ESC."""
from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy
from bpy.app.translations import pgettext_iface

from .again import is_repeated, start_again, starts_again
from .between_events import steps_taken, works
from .interrupts import interrupt_held
from .status_bar import StatusBar
from .steps import Beside, Steps, Undivided
from .told import tell
from .unforeseen import sentence

INTERVAL = 0.02
# the window answers to ESC and draws the progress this often, where single steps are not longer
BUDGET = 0.1


class SteppedOperator:
    """Mix-in of operators whose `steps(context)` yields (fraction, stage), and leaves no trace where it is closed."""

    # no annotation: Blender takes those of an operator for its properties
    _running = None
    # message on what ESC leaves behind
    unchanged = "nothing has changed"

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set:
        if is_repeated(self):
            start_again(self, context)
            return {"CANCELLED"}
        self._running = self.steps(context)
        with interrupt_held() as heard, steps_taken(apart=False), _at_the_cursor(context) as show:
            while (outcome := self._step()) is None and not heard:
                show(self._progress[0])
            self._running.close()
        return outcome

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.begin(context)

    def begin(self, context: bpy.types.Context) -> set:
        """Take the first step; the others follow in the window of the context."""
        self._running = self.steps(context)
        # wrong input is told at once, before anything of the window changes
        outcome = self._step_apart()
        if outcome is not None:
            return outcome
        works(True)
        manager = context.window_manager
        self._bar = StatusBar()
        self._timer = manager.event_timer_add(INTERVAL, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            tell(self, {"INFO"}, f"{pgettext_iface(self.bl_label)}: cancelled, {self.unchanged}.")
            return {"CANCELLED"}
        # all other events end here: nobody may change the scene between two steps
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        enough = time.perf_counter() + BUDGET
        outcome = self._step_apart()
        while outcome is None and time.perf_counter() < enough and not self._stands_alone:
            outcome = self._step_apart()
        if outcome is not None:
            self._tidy(context)
            return outcome
        self._show(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop without a trace; Blender calls it too, when it ends the operator itself, be it before the work began."""
        if self._running is None:
            return
        try:
            self._running.close()
        finally:
            self._tidy(context)

    @property
    def _stands_alone(self) -> bool:
        """Return True if the next step is shown before it starts, or only waits for the next event."""
        return isinstance(self._progress[1], Undivided | Beside)

    @property
    def _undivided(self) -> bool:
        """Return True if the next step cannot be divided."""
        return isinstance(self._progress[1], Undivided)

    def _step_apart(self) -> set | None:
        """Take one step between events of the window.

        Return None if there are more steps, else the operator's result: {"FINISHED"}, or {"CANCELLED"} after an error.
        """
        with steps_taken(apart=True):
            return self._step()

    def _step(self) -> set | None:
        """Take one step. Return the operator's result after the last step, else None."""
        try:
            self._progress = next(self._running)
        except StopIteration:
            return {"FINISHED"}
        except Exception as error:
            tell(self, {"ERROR"}, sentence(error, pgettext_iface(self.bl_label)))
            return {"CANCELLED"}
        return None

    def _show(self, context: bpy.types.Context) -> None:
        """Show the progress and the next stage."""
        fraction, stage = self._progress
        stopping = pgettext_iface("ESC: Cancel After This Step" if self._undivided else "ESC: Cancel")
        context.window_manager.progress_update(100.0 * fraction)
        context.workspace.status_text_set(self._bar.told(fraction, stage, stopping))

    def _tidy(self, context: bpy.types.Context) -> None:
        works(False)
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        context.workspace.status_text_set(None)


@contextmanager
def _at_the_cursor(context: bpy.types.Context) -> Iterator[Callable[[float], None]]:
    """Show the progress of a script at the cursor while it blocks a window. Yield a function that takes the fraction, 0
    to 1.
    """
    if bpy.app.background or context.window is None:
        yield lambda fraction: None
        return
    manager = context.window_manager
    manager.progress_begin(0, 100)
    try:
        yield lambda fraction: manager.progress_update(100.0 * fraction)
    finally:
        manager.progress_end()


class BrowsingOperator(SteppedOperator):
    """A stepped operator that in a window lets the user choose its `filepath` first."""

    # True while the file browser is open, which calls `execute` with the answer
    _browsing = False

    def begin(self, context: bpy.types.Context) -> set:
        self._browsing = not self._browsing and not starts_again()
        if not self._browsing:
            return super().begin(context)
        if not self.properties.is_property_set("filepath", ghost=False):
            self.filepath = proposed(self.properties.bl_rna.properties["filepath"].default)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set:
        return self.begin(context) if self._browsing else super().execute(context)


def proposed(path: str) -> str:
    """Return the initial path of a file browser for an operator that writes to `path`, which begins with "//". Without
    it, Blender proposes the open file's name. For files that were never saved, it is the name only.
    """
    return bpy.path.abspath(path) if bpy.data.filepath else bpy.path.basename(path)
