"""The state machine of Live. It is notified of changes, does one step at each call, and gets the time from the caller.
"""
from __future__ import annotations

import time
from dataclasses import replace

import bpy

from ...core import ReflectionError, View
from ..faults import sentence
from ..freshness import same_view, view_numbers
from .eye import read_eye
from .following import Following
from .pace import Pace
from .thrown import ThrownLight
from .watched import Record, Watched, watched
from .work import Work

PAUSE = 0.25    # seconds without a change after which what is shown is made exact
WAITS = "Live waits for Object Mode."
NOTHING_YET = "Generate a reflection first."
LONG = 0.5      # seconds of moving vertices before new results are started during movement, and
REST = 4.0      # factor of the duration of new results


class LiveUpdater:
    """Keeps the results of a scene up to date: reflections here, caustics in `thrown`.

    `note` reports that something may have changed. `step` is called repeatedly; it finds the change and does a part of
    the work. Between two steps it refers to Blender's data only in the work in progress, which `forget` ends.

    Attributes
    ----------
    of_viewport : bool
        True if results are made for the 3D viewport's view.
    milliseconds : float
        Duration of the last update.
    thrown : ThrownLight
    following : Following
    updates : dict of str to int
        Number of updates by kind: `followed`, `coarse` and `exact`.
    """

    def __init__(self, of_viewport: bool = False) -> None:
        self.of_viewport = of_viewport
        self.milliseconds, self.thrown, self.following = 0.0, ThrownLight(), Following()
        self._told, self._rests = "", False
        self.updates = {"followed": 0, "coarse": 0, "exact": 0}
        self._pace = Pace()
        self._noted = self._moved = True
        self._record: Record | None = None  # inputs that the results show
        self._looked: Record | None = None  # inputs found at the last look
        self._changed = 0.0                 # time of the last change of these
        self._work: Work | None = None
        self._moving: float | None = None   # time since when vertices have followed
        self._took = 0.0                    # seconds that the last new results took

    @property
    def told(self) -> str:
        """Message on what prevents updates or went wrong; empty if nothing does."""
        only_light = self._told == NOTHING_YET and self.thrown.is_there
        return self.thrown.told or ("" if only_light else self._told)

    @property
    def at_rest(self) -> bool:
        """True if all results are up to date."""
        return self._rests and self.thrown.at_rest

    def note(self, moved: bool = True) -> None:
        """Note that something may have changed: the view only, or, if `moved`, a mirror or a reflected object."""
        self._noted, self._moved = True, self._moved or moved
        if moved:
            self.thrown.note()

    def forget(self) -> None:
        """Release Blender's data and everything that is known of the file, which may be replaced."""
        self._drop_work()
        self.following.forget()
        self._record, self._looked, self._rests = None, None, False
        self.thrown.forget()
        self.note()

    def step(self, context: bpy.types.Context, now: float) -> str:
        """Do one step. Return "followed", "coarse" or "exact" after an update, "working", or "" if there was nothing to
        do.
        """
        try:
            done = self._step(context, now)
        except ReflectionError as error:
            done = self._give_up(str(error))
        except Exception as error:
            done = self._give_up(sentence(error, "Live"))
        light = self.thrown.step(context, now)
        if light in self.updates:
            self.updates[light] += 1
            self.milliseconds = 1000.0 * self.thrown.seconds
        return done or light

    def _step(self, context: bpy.types.Context, now: float) -> str:
        if context.mode != "OBJECT":
            self._drop_work()
            self._told = WAITS
            return ""
        if self.following.is_under_way:
            # all else waits for that
            return self._go_on_following(context, now)
        if not (self._noted or self.of_viewport):
            if self._rests or (self._work is None and now - self._changed < PAUSE):
                return ""
        started = time.perf_counter()
        view = read_eye(context, self.of_viewport)
        if self._noted or self._looked is None or not same_view(view_numbers(view), self._looked.view):
            current = self._look(context, view, now)
            if current is None:
                return ""
            if not current.record.same(self._record):
                return self._change(context, current, now, started)
        if self._rests:
            return ""
        rested = now - self._changed >= PAUSE
        if rested and self._work is not None and self.following.tracks and not self._work.exact:
            self._drop_work()
        if self._work is None:
            if not rested:
                return ""
            self._begin(context, watched(context, view), now)
        return self._go_on(context, view, now)

    def _look(self, context: bpy.types.Context, view: View, now: float) -> Watched | None:
        """Return the present inputs; None if there are no results to update."""
        current = watched(context, view, None if self._moved else self._looked)
        self._noted = self._moved = False
        if not current.chosen:
            self._drop_work()
            self.following.forget()
            self._told, self._looked, self._record = NOTHING_YET, None, None
            self._rests = True
            return None
        self._told = ""
        if not current.record.same(self._looked):
            # update exactly at once when Live starts
            self._changed = now if self._looked is not None else now - PAUSE
            self._rests = False
        self._looked = current.record
        return current

    def _change(self, context: bpy.types.Context, current: Watched, now: float, started: float) -> str:
        """React to inputs that differ from those shown."""
        work = self._work
        if work is not None and not current.record.same(work.record) and (
                not work.on_the_way or current.record.members != work.record.members):
            self._drop_work()
        if self.following.begin(context, current, self._record, started):
            return self._go_on_following(context, now)
        if self._work is None:
            self._begin(context, current, now)
        return self._go_on(context, current.view, now)

    def _begin(self, context: bpy.types.Context, current: Watched, now: float) -> None:
        """Start new results: coarse ones, or exact ones if nothing moves."""
        settings, on_the_way = current.record.settings, now - self._changed < PAUSE
        if on_the_way:
            settings = {mirror: replace(own, tolerance=self._pace.coarse(own.tolerance))
                        for mirror, own in settings.items()}
        self._work = Work.of(context, current, settings, on_the_way)

    def _go_on_following(self, context: bpy.types.Context, now: float) -> str:
        """Advance the update of the vertices by one time slice. Finish the update at the end."""
        done = self.following.go_on(context)
        if done == "lost":
            self._noted = self._moved = True
            return "working"
        if done != "followed":
            return done
        self._record = self.following.record
        self.milliseconds = 1000.0 * self.following.seconds
        self.updates["followed"] += 1
        self._pace.took(self.following.seconds)
        self._moving = now if self._moving is None else self._moving
        begins = self._work is None and now - self._moving > max(LONG, REST * self._took)
        if begins or self._work is not None:
            view = read_eye(context, self.of_viewport)
            if begins:
                self._begin(context, watched(context, view), now)
            self._go_on(context, view, now)
        return "followed"

    def _go_on(self, context: bpy.types.Context, view: View, now: float) -> str:
        """Work on the next results."""
        work = self._work
        if not work.go_on():
            return "working"
        self._work, self._moving, self._took = None, None, work.seconds
        self._told, self.milliseconds = work.told, 1000.0 * work.seconds
        self.following.learn(work)
        self.following.go_on(context)
        self._record, self._rests = work.record, work.exact
        kind = "exact" if work.exact else "coarse"
        self.updates[kind] += 1
        if work.on_the_way and not self.following.tracks:
            self._pace.took(work.seconds)
        current = watched(context, view)
        if current.record.same(work.record):
            return kind
        # all has moved on meanwhile, and nobody is to see where it was
        self._noted, self._moved, self._rests = True, True, False
        if not self.following.is_under_way and self.following.begin(context, current, self._record,
                                                                    time.perf_counter()):
            self._go_on_following(context, now)
        return kind

    def _drop_work(self) -> None:
        work, self._work = self._work, None
        if work is not None:
            work.close()

    def _give_up(self, told: str) -> str:
        """Wait for the next change, since nothing can be done before it."""
        self._drop_work()
        self.following.forget()
        self._record, self._looked, self._rests, self._told = None, None, True, told
        return ""
