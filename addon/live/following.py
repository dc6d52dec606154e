"""Move the vertices of results along with moving objects, a time slice at a time."""
from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import bpy

from ..freshness import COARSE
from ..reading import known_results
from ..standing import Kept
from .track import Track, Written
from .turns import InTurns
from .watched import Record, Watched
from .work import Work


class Following:
    """Moves the vertices of results, of all or of none.

    Attributes
    ----------
    tracks : list of Track
        The tracked results; empty if they cannot be tracked.
    record : Record or None
        Inputs that the results show after the last update.
    seconds, turns : float, int
        Duration of that update, and its number of time slices.
    """

    def __init__(self) -> None:
        self.tracks: list[Track] = []
        self.record: Record | None = None
        self.seconds, self.turns = 0.0, 0
        self._meshes: dict = {}  # by mirror: its mesh and the scene's, as the results show them
        # arrays at work, and what is done with what they find
        self._under_way: tuple[InTurns, Callable[[bpy.types.Context, InTurns], str]] | None = None

    @property
    def is_under_way(self) -> bool:
        """True if an update is in progress."""
        return self._under_way is not None

    def forget(self) -> None:
        """Stop tracking."""
        under_way, self._under_way = self._under_way, None
        if under_way is not None:
            under_way[0].close()
        self.tracks, self._meshes = [], {}

    def learn(self, work: Work) -> None:
        """Start to prepare tracking of the results that were just written."""
        self.forget()
        wanted = []
        for outcome in work.outcomes:
            view, surfaces, scene = outcome.read
            for obj, result in outcome.results:
                mirror = obj.reflection_mesh.mirror
                self._meshes[mirror.session_uid] = meshes = surfaces[mirror].mesh, scene.mesh
                written = [obj, *(copy for copy in outcome.copies if copy.reflection_mesh.mirror == mirror)]
                shown = Written.of(written, mirror, work.settings[mirror.session_uid].placement)
                wanted.append(partial(Track.of, shown, result, view, *meshes))
                if not work.exact:
                    for one in written:
                        one.reflection_mesh.made_from = COARSE
        self._under_way = InTurns(lambda: [track() for track in wanted]), self._learned

    def begin(self, context: bpy.types.Context, current: Watched, shown: Record | None, started: float) -> bool:
        """Start an update from the inputs `shown` to the `current` ones. Return True if that is possible.

        `started` is the time at which the caller began to look; it counts as part of the update.
        """
        wanted = {one.mirror.session_uid for group in current.chosen for one in group.assemblies}
        if shown is None or not self.tracks or {track.mirror for track in self.tracks} != wanted:
            return False
        if current.record.members != shown.members:
            # these may be another camera's results
            self.tracks = []
            return False
        meshes, tracks, view = self._meshes, self.tracks, current.view
        if current.record.digests != shown.digests:
            meshes = _read(context, current)
        if not self._fits(_results(context), meshes):
            return False
        turns = InTurns(lambda: [track.seen(view, *meshes[track.mirror]) for track in tracks])
        turns.seconds = time.perf_counter() - started
        self._under_way = turns, partial(self._followed, current.record, meshes)
        return True

    def go_on(self, context: bpy.types.Context) -> str:
        """Run one time slice. Return "working", "followed" when done, "lost" if results have changed meanwhile, or ""
        if only the preparation is complete.
        """
        turns, then = self._under_way
        if not turns.go_on():
            return "working"
        self._under_way = None
        return then(context, turns)

    def _learned(self, context: bpy.types.Context, turns: InTurns) -> str:
        if all(track is not None for track in turns.result):
            self.tracks = turns.result
        return ""

    def _followed(self, record: Record, meshes: dict, context: bpy.types.Context, turns: InTurns) -> str:
        """Write the new positions of the results."""
        started, objects = time.perf_counter(), _results(context)
        if not self._fits(objects, meshes):
            return "lost"
        self.tracks = [track.written(objects, seen) for track, seen in zip(self.tracks, turns.result)]
        self._meshes, self.record = meshes, record
        self.seconds, self.turns = turns.seconds + time.perf_counter() - started, turns.turns
        return "followed"

    def _fits(self, objects: dict, meshes: dict) -> bool:
        """Return True if all results can be updated to these meshes. Otherwise stop tracking."""
        fits = all(track.fits(objects, *meshes[track.mirror]) for track in self.tracks)
        if not fits:
            self.tracks = []
        return fits


def _results(context: bpy.types.Context) -> dict:
    """Return the results of the scene by their `session_uid`."""
    return {obj.session_uid: obj for obj in known_results(context.scene, context.view_layer)}


def _read(context: bpy.types.Context, current: Watched) -> dict:
    """Return the meshes of each mirror and of its sources, by the mirror's `session_uid`."""
    depsgraph = context.evaluated_depsgraph_get()
    meshes = {}
    for group in current.chosen:
        stage = Kept.of(depsgraph).read(depsgraph, list(group.assemblies), group.diffuse)
        meshes.update({one.mirror.session_uid: (surface.mesh, stage.scene.mesh)
                       for one, surface in zip(group.assemblies, stage.surfaces)})
    return meshes
