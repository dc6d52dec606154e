"""The results that follow what moves: how each does, and the work on that which is under way, a turn at each look."""
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
    """Lets the vertices of results follow, all of them or none.

    Attributes
    ----------
    tracks : list of Track
        How results are followed; empty where they are not.
    record : Record or None
        What they show, as soon as they have followed.
    seconds, turns : float, int
        What that took.
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
        """Whether there is work to go on with."""
        return self._under_way is not None

    def forget(self) -> None:
        """Follow no more."""
        under_way, self._under_way = self._under_way, None
        if under_way is not None:
            under_way[0].close()
        self.tracks, self._meshes = [], {}

    def learn(self, work: Work) -> None:
        """Begin to find out how the results that were written just now can be followed."""
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
        """Begin to follow from what the results show to what there is; whether that is possible.

        `started` is when whoever asks began to look, which counts as a part of it.
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
        """A turn of the work: "working", or "followed"; "lost" where results have changed meanwhile; "" where it is
        known how to follow."""
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
        """Write where the results have gone."""
        started, objects = time.perf_counter(), _results(context)
        if not self._fits(objects, meshes):
            return "lost"
        self.tracks = [track.written(objects, seen) for track, seen in zip(self.tracks, turns.result)]
        self._meshes, self.record = meshes, record
        self.seconds, self.turns = turns.seconds + time.perf_counter() - started, turns.turns
        return "followed"

    def _fits(self, objects: dict, meshes: dict) -> bool:
        """Whether all can follow to these meshes; where they cannot, they are not followed any more."""
        fits = all(track.fits(objects, *meshes[track.mirror]) for track in self.tracks)
        if not fits:
            self.tracks = []
        return fits


def _results(context: bpy.types.Context) -> dict:
    """The results of the scene by their `session_uid`."""
    return {obj.session_uid: obj for obj in known_results(context.scene, context.view_layer)}


def _read(context: bpy.types.Context, current: Watched) -> dict:
    """The meshes of each mirror and of what it shows, by the mirror's `session_uid`."""
    depsgraph = context.evaluated_depsgraph_get()
    meshes = {}
    for group in current.chosen:
        stage = Kept.of(depsgraph).read(depsgraph, list(group.assemblies), group.diffuse)
        meshes.update({one.mirror.session_uid: (surface.mesh, stage.scene.mesh)
                       for one, surface in zip(group.assemblies, stage.surfaces)})
    return meshes
