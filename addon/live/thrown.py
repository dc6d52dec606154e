"""The light that mirrors throw, kept right: made anew at a coarse tolerance on the way, and exactly at rest."""
from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import NamedTuple

import bpy

from ...core import ReflectionError, Settings
from ..faults import Steps, sentence
from ..frames import plays
from ..freshness import COARSE, digest_of, lamp_numbers, light_record
from ..illumination import Tint, blocking, places_kept, results_with
from ..operators.caustics import Asked, NothingThrown, throwing
from ..reading import NothingSeen, Participants, materials_shown, seen_in, visible
from ..settings import Wanted
from .pace import Pace

PAUSE = 0.25    # seconds without a change after which all is made exact
BUDGET = 0.05   # seconds of work between two looks at what has changed


class Group(NamedTuple):
    """Caustics that are made together, since their light falls on the same objects.

    Attributes
    ----------
    pairs : set of (bpy.types.Object, bpy.types.Object)
        Mirror and lamp of each of the caustics, including those that are hidden.
    chosen : Participants or None
        The mirrors of `pairs` and the receivers (as `diffuse`) that are visible. None if all mirrors or all receivers
        are hidden.
    lamps : list of bpy.types.Object
        The lamps of `pairs` that are visible.
    """

    pairs: set
    chosen: Participants | None
    lamps: list


class Record(NamedTuple):
    """The inputs of caustics without references to Blender's data, which may be removed: digests, settings and
    participants of each group.
    """

    digests: tuple
    settings: tuple
    members: tuple


@dataclass
class Work:
    """The generation of all groups, one after another, in time slices."""

    record: Record
    exact: bool
    waiting: list
    seconds: float = 0.0


class ThrownLight:
    """Keeps the caustics of a scene up to date, as `LiveUpdater` does for reflections.

    Attributes
    ----------
    at_rest, is_there : bool
        True if everything is up to date; True if there are caustics.
    told : str
        Message on what went wrong; empty if nothing did.
    seconds : float
        Duration of the last update.
    """

    def __init__(self) -> None:
        self.at_rest, self.is_there, self.told, self.seconds = False, False, "", 0.0
        self._pace, self._noted, self._changed = Pace(), True, 0.0
        self._shown: Record | None = None   # inputs of the shown caustics, if these are exact
        self._coarse: Record | None = None  # inputs of the shown caustics, if these are coarse
        self._looked: Record | None = None  # inputs found at the last look
        self._work: Work | None = None

    def note(self) -> None:
        """Note that something may have changed."""
        self._noted = True

    def forget(self) -> None:
        """Release Blender's data and everything that is known of the file."""
        self._drop()
        self._shown = self._coarse = self._looked = None
        self._noted, self.at_rest = True, False

    def step(self, context: bpy.types.Context, now: float) -> str:
        """Do one step. Return "coarse" or "exact" after an update, "working", or "" if there was nothing to do."""
        if context.mode != "OBJECT":
            self._drop()
            return ""
        try:
            if self._noted:
                self._look(context, now)
            if self.at_rest:
                return ""
            if self._work is None and not self._begin(context, now):
                return ""
            return self._go_on()
        except Exception as error:
            self._drop()
            self._shown, self.at_rest = None, True
            self.told = str(error) if isinstance(error, ReflectionError) else sentence(error, "Live")
            return ""

    def _look(self, context: bpy.types.Context, now: float) -> None:
        """Compare the present inputs with those shown."""
        self._noted, groups = False, light_groups(context)
        self.is_there = bool(groups)
        if not groups:
            self._drop()
            self._looked, self.at_rest, self.told = None, True, ""
            return
        record = _record(context, groups)
        if record != self._looked:
            # update exactly at once when Live starts
            self._changed = now if self._looked is not None else now - PAUSE
            # finish coarse caustics, since otherwise none would ever be shown
            if self._work is not None and (self._work.exact or record.members != self._work.record.members):
                self._drop()
        self._looked, self.at_rest = record, record == self._shown

    def _begin(self, context: bpy.types.Context, now: float) -> bool:
        """Start new caustics, coarse ones while something moves. Return True if any are needed."""
        rests = now - self._changed >= PAUSE
        if not rests and self._coarse == self._looked:
            return False
        groups, wanted = light_groups(context), Wanted(context.scene)
        exact = {mirror: wanted(mirror) for group in groups for mirror, _ in group.pairs}
        settings = exact if rests else {mirror: replace(own, tolerance=self._pace.coarse(own.tolerance))
                                        for mirror, own in exact.items()}
        self._work = Work(self._looked, settings == exact, [
            made_anew(context, group, settings, settings == exact) for group in groups])
        return True

    def _go_on(self) -> str:
        work, started = self._work, time.perf_counter()
        while work.waiting:
            try:
                next(work.waiting[0])
            except StopIteration:
                del work.waiting[0]
            if time.perf_counter() - started >= BUDGET:
                break
        work.seconds += time.perf_counter() - started
        if work.waiting:
            return "working"
        self._work, self.seconds, self.told = None, work.seconds, ""
        self._pace.took(work.seconds)
        self._shown, self._coarse = (work.record, None) if work.exact else (None, work.record)
        self.at_rest = self._shown == self._looked
        return "exact" if work.exact else "coarse"

    def _drop(self) -> None:
        work, self._work = self._work, None
        if work is not None:
            # some of it may have been written
            self._shown = None
            for steps in work.waiting:
                steps.close()


def light_groups(context: bpy.types.Context) -> list[Group]:
    """Return the caustics of the scene that are updated, grouped by the objects on which they fall."""
    layer, found = set(context.view_layer.objects), {}
    for obj in context.scene.objects:
        record = obj.reflection_mesh
        if record.role != "CAUSTICS" or obj not in layer or record.mirror not in layer or record.lamp not in layer or (
                plays(obj) or obj not in results_with(context, record.mirror, record.lamp)):
            continue
        sources = tuple(source.object for source in record.sources if source.object is not None)
        if sources and record.mirror not in sources:
            found.setdefault(sources, {})[record.mirror, record.lamp] = None
    groups, is_seen = [], seen_in(context)
    for sources, pairs in found.items():
        try:
            mirrors = list(dict.fromkeys(mirror for mirror, _ in pairs))
            chosen = visible(context, mirrors, list(sources), unmirrored=True)
        except NothingSeen:
            chosen = None
        lamps = list(dict.fromkeys(lamp for _, lamp in pairs))
        groups.append(Group(set(pairs), chosen, list(filter(is_seen, lamps))))
    return groups


def _record(context: bpy.types.Context, groups: list[Group]) -> Record:
    depsgraph, wanted = context.evaluated_depsgraph_get(), Wanted(context.scene)
    digests, settings, members = [], [], []
    for group in groups:
        chosen = group.chosen or Participants([], [], [])
        mirrors = sorted({mirror for mirror, _ in group.pairs}, key=lambda mirror: mirror.session_uid)
        objects = [chosen.mirrors, chosen.diffuse, blocking(context, chosen)]
        places = places_kept(context, mirrors, group.lamps)
        shown = materials_shown(depsgraph, mirrors)
        digests.append((tuple(digest_of(depsgraph, some) for some in objects),
                        tuple(lamp_numbers(depsgraph, lamp) for lamp in group.lamps),
                        tuple(repr(Tint.of_material(material))
                              for mirror in mirrors for material in shown[mirror])))
        settings.append((tuple(wanted(mirror) for mirror in mirrors), tuple(places.values())))
        members.append(tuple(tuple(obj.session_uid for obj in some) for some in (*objects, group.lamps))
                       + tuple(sorted((mirror.session_uid, lamp.session_uid) for mirror, lamp in group.pairs)))
    return Record(tuple(digests), tuple(settings), tuple(members))


def made_anew(context: bpy.types.Context, group: Group, settings: dict[bpy.types.Object, Settings],
              exact: bool = True) -> Steps[None]:
    """Make the caustics of a group. Pairs that cast none at the moment get an empty mesh."""
    dark = group.pairs
    if group.chosen is not None and group.lamps:
        mirrors = list(dict.fromkeys(mirror for mirror, _ in group.pairs))
        places = places_kept(context, mirrors, group.lamps)
        asked = Asked(places, lambda mirror: settings[mirror], False, keep_materials=True)
        try:
            thrown = yield from throwing(context, group.chosen, group.lamps, asked, group.pairs)
            made = {(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp) for obj in thrown.objects}
            tried = {(mirror, lamp) for mirror, lamp in group.pairs
                     if mirror in group.chosen.mirrors and lamp in group.lamps}
            dark = {pair for pair in group.pairs - made if pair in thrown.dark or pair not in tried}
        except NothingThrown:
            pass
    for pair in group.pairs:
        for obj in results_with(context, *pair)[:1]:
            record = obj.reflection_mesh
            if pair in dark and len(obj.data.vertices):
                obj.data.clear_geometry()
            if pair in dark:
                _forget_removed(record.sources)
                record.made_from = light_record(context, *pair, [source.object for source in record.sources])
            if not exact:
                record.made_from = COARSE


def _forget_removed(sources: bpy.types.bpy_prop_collection) -> None:
    """Remove deleted objects from the lit objects in a record."""
    for index in reversed([number for number, source in enumerate(sources) if source.object is None]):
        sources.remove(index)
