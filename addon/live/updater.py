"""The heart of Live: told of changes, asked to work every now and then, by a clock that is given."""
from __future__ import annotations

import time
from dataclasses import replace

import bpy

from ...core import ReflectionError, View
from ..faults import sentence
from ..freshness import COARSE, same_view, view_numbers
from ..reading import known_results
from ..standing import Kept
from .eye import read_eye
from .pace import Pace
from .thrown import ThrownLight
from .track import Track
from .watched import Record, Watched, watched
from .work import Work

PAUSE = 0.25    # seconds without a change after which what is shown is made exact
WAITS = "Live waits for Object Mode."
NOTHING_YET = "Generate a reflection first."
LONG = 0.5      # seconds that vertices follow before new results are begun on the way, and
REST = 4.0      # how many times what these take


class LiveUpdater:
    """Keeps the results of a scene right: reflections here, and light that mirrors throw by `thrown`.

    `note` is told that something may have changed; `step`, asked every now and then, finds out what, and works a
    little. Between two steps it holds nothing of Blender's but the work that is under way, which `forget` ends.

    Attributes
    ----------
    of_viewport : bool
        Whether results are right for the 3D viewport's view.
    milliseconds : float
        What the last update took.
    thrown : ThrownLight
    updates : dict of str to int
        How many there were: `followed`, `coarse` and `exact`.
    """

    def __init__(self, of_viewport: bool = False) -> None:
        self.of_viewport = of_viewport
        self.milliseconds, self.thrown = 0.0, ThrownLight()
        self._told, self._rests = "", False
        self.updates = {"followed": 0, "coarse": 0, "exact": 0}
        self._pace = Pace()
        self._noted = self._moved = True
        self._record: Record | None = None  # what the results show
        self._looked: Record | None = None  # what was found at the last look
        self._changed = 0.0                 # when that was another thing than before
        self._tracks: list[Track] = []
        self._meshes: dict = {}             # by mirror: its mesh and the scene's, as the results show them
        self._work: Work | None = None
        self._moving: float | None = None   # since when vertices have followed
        self._took = 0.0                    # seconds that the last new results took

    @property
    def told(self) -> str:
        """What keeps it from working, or what went wrong; empty where nothing does."""
        only_light = self._told == NOTHING_YET and self.thrown.is_there
        return self.thrown.told or ("" if only_light else self._told)

    @property
    def at_rest(self) -> bool:
        """Whether all is as it is to be."""
        return self._rests and self.thrown.at_rest

    def note(self, moved: bool = True) -> None:
        """Something may have changed: the view alone, or, where it `moved`, what mirrors or is reflected."""
        self._noted, self._moved = True, self._moved or moved
        if moved:
            self.thrown.note()

    def forget(self) -> None:
        """Let go of all that is Blender's and of what is known of the file, which may be another one now."""
        self._drop_work()
        self._tracks, self._meshes, self._record, self._looked, self._rests = [], {}, None, None, False
        self.thrown.forget()
        self.note()

    def step(self, context: bpy.types.Context, now: float) -> str:
        """Work a little; returns what was done: "followed", "coarse", "exact", "working", or "" for nothing."""
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
        if rested and self._work is not None and self._tracks and not self._work.exact:
            self._drop_work()
        if self._work is None:
            if not rested:
                return ""
            self._begin(context, watched(context, view), now)
        return self._go_on(context, view, now)

    def _look(self, context: bpy.types.Context, view: View, now: float) -> Watched | None:
        """How all stands now; None where there is nothing to keep right."""
        current = watched(context, view, None if self._moved else self._looked)
        self._noted = self._moved = False
        if not current.chosen:
            self._drop_work()
            self._told, self._looked, self._record, self._tracks = NOTHING_YET, None, None, []
            self._rests = True
            return None
        self._told = ""
        if not current.record.same(self._looked):
            # what Live begins with is made exact at once
            self._changed = now if self._looked is not None else now - PAUSE
            self._rests = False
        self._looked = current.record
        return current

    def _change(self, context: bpy.types.Context, current: Watched, now: float, started: float) -> str:
        """The results show something else than what there is."""
        work = self._work
        if work is not None and not current.record.same(work.record) and (
                not work.on_the_way or current.record.members != work.record.members):
            self._drop_work()
        if self._follow(context, current):
            self.milliseconds = 1000.0 * (time.perf_counter() - started)
            self.updates["followed"] += 1
            self._pace.took(time.perf_counter() - started)
            self._moving = now if self._moving is None else self._moving
            if self._work is None and now - self._moving > max(LONG, REST * self._took):
                self._begin(context, current, now)
            if self._work is not None:
                self._go_on(context, current.view, now)
            return "followed"
        if self._work is None:
            self._begin(context, current, now)
        return self._go_on(context, current.view, now)

    def _begin(self, context: bpy.types.Context, current: Watched, now: float) -> None:
        """Begin new results: coarse ones, or exact ones where nothing moves."""
        settings, on_the_way = current.record.settings, now - self._changed < PAUSE
        if on_the_way:
            settings = {mirror: replace(own, tolerance=self._pace.coarse(own.tolerance))
                        for mirror, own in settings.items()}
        self._work = Work.of(context, current, settings, on_the_way)

    def _follow(self, context: bpy.types.Context, current: Watched) -> bool:
        """Let all results follow; whether that is possible."""
        wanted = {mirror.session_uid for group in current.chosen for mirror in group.mirrors}
        if self._record is None or not self._tracks or {track.mirror for track in self._tracks} != wanted:
            return False
        if current.record.members != self._record.members:
            # these may be another camera's results
            self._tracks = []
            return False
        meshes = self._meshes
        if current.record.digests != self._record.digests:
            meshes = _read(context, current)
        objects = {obj.session_uid: obj for obj in known_results(context.scene, context.view_layer)}
        if not all(track.fits(objects, *meshes[track.mirror]) for track in self._tracks):
            self._tracks = []
            return False
        self._tracks = [track.moved(objects, current.view, *meshes[track.mirror]) for track in self._tracks]
        self._meshes, self._record = meshes, current.record
        return True

    def _go_on(self, context: bpy.types.Context, view: View, now: float) -> str:
        """Some work on the next results."""
        work = self._work
        if not work.go_on():
            return "working"
        self._work, self._moving, self._took = None, None, work.seconds
        self._told, self.milliseconds = work.told, 1000.0 * work.seconds
        self._keep_track(work)
        self._record, self._rests = work.record, work.exact
        kind = "exact" if work.exact else "coarse"
        self.updates[kind] += 1
        if work.on_the_way and not self._tracks:
            self._pace.took(work.seconds)
        current = watched(context, view)
        if current.record.same(work.record):
            return kind
        # all has moved on meanwhile, and nobody is to see where it was
        self._noted, self._moved, self._rests = True, True, False
        self._follow(context, current)
        return kind

    def _keep_track(self, work: Work) -> None:
        """Remember how to follow new results, if all of them can be."""
        self._tracks, self._meshes = [], {}
        tracks = []
        for outcome in work.outcomes:
            view, surfaces, scene = outcome.read
            for obj, result in outcome.results:
                mirror = obj.reflection_mesh.mirror
                meshes = surfaces[mirror].mesh, scene.mesh
                written = [obj, *(copy for copy in outcome.copies if copy.reflection_mesh.mirror == mirror)]
                tracks.append(Track.of(written, result, work.settings[mirror.session_uid].placement, view, *meshes))
                self._meshes[mirror.session_uid] = meshes
                if not work.exact:
                    for one in written:
                        one.reflection_mesh.made_from = COARSE
        if all(track is not None for track in tracks):
            self._tracks = tracks

    def _drop_work(self) -> None:
        work, self._work = self._work, None
        if work is not None:
            work.close()

    def _give_up(self, told: str) -> str:
        """Nothing can be done before the next change."""
        self._drop_work()
        self._tracks, self._record, self._looked, self._rests, self._told = [], None, None, True, told
        return ""


def _read(context: bpy.types.Context, current: Watched) -> dict:
    """The meshes of each mirror and of what it shows, by the mirror's `session_uid`."""
    depsgraph = context.evaluated_depsgraph_get()
    meshes = {}
    for group in current.chosen:
        stage = Kept.of(depsgraph).read(depsgraph, group.mirrors, group.diffuse)
        meshes.update({mirror.session_uid: (surface.mesh, stage.scene.mesh)
                       for mirror, surface in zip(group.mirrors, stage.surfaces)})
    return meshes
