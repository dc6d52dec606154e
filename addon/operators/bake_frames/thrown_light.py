"""Light that mirrors throw, in frames that play it without this extension."""
from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from .... import core
from ...faults import AllOrNothing, Steps, still_there
from ...frames import Sequence, play_caustics, player_of, told_apart
from ...illumination import follow_layers, leave_out, places_kept, results_with
from ...reading import Assembly, NothingSeen, candidates, materials_shown, seen_in, visible
from ...settings import of_each
from ...writing import set_free, told_of
from ..caustics import Asked, NothingThrown, keep_own, left_out_before, name_of, throwing
from ..clear import remove_caustics
from ..shortcomings import Refused
from .plan import Plan


@dataclass
class ThrownLight:
    """Bakes caustics of lamps frame by frame.

    Attributes
    ----------
    pairs : dict of str to (bpy.types.Object, bpy.types.Object)
        Mirror and lamp by the name of their caustics.
    diffuse : list of bpy.types.Object
    places : dict
        Number of points on each lamp, by (mirror, lamp).
    receivers : dict
        Materials of the lit objects in the open frame, by result.
    layers : int
        Number of faces that overlap in the open frame.
    lacks : dict
        Sentences on what is missing in the caustics, by frame.
    """

    pairs: dict
    diffuse: list
    places: dict
    receivers: dict = field(default_factory=dict)
    layers: int = 0
    lacks: dict = field(default_factory=dict)

    role = "CAUSTICS"

    @classmethod
    def of(cls, context: bpy.types.Context, plan: Plan, mirrors: list, diffuse: list) -> ThrownLight:
        """Return the caustics that a plan asks for.

        Raises
        ------
        core.ReflectionError
            If it names several cameras.
        """
        if len(plan.cameras) > 1:
            raise core.ReflectionError("The light that mirrors throw is the same for all cameras: name one at most.")
        kept = {} if plan.eyes else places_kept(context, mirrors, list(plan.lamps))
        pairs = pairs_of(mirrors, plan.lamps)
        return cls(pairs, diffuse, {pair: kept.get(pair, max(plan.eyes, 1)) for pair in pairs.values()})

    @property
    def keys(self) -> list[str]:
        """Keys of the results in the records of frames: the names of the caustics."""
        return list(self.pairs)

    def take(self, name: str) -> str:
        """Return the name under which a sequence stores its records."""
        return f"Caustics {name}".strip()

    def file(self, key: str, take: str) -> str:
        return f"{told_apart(self.keys)[key]} {take}".strip()

    def made_with(self, context: bpy.types.Context, plan: Plan, camera: bpy.types.Object | None) -> dict:
        return {**plan.made_with(context, camera, self._mirrors), "samples": 0,
                "places": {key: self.places[pair] for key, pair in self.pairs.items()}}

    def origin(self, context: bpy.types.Context, plan: Plan) -> dict:
        """Return no inputs: changes of caustics are not tracked here."""
        return {}

    def frame(self, context: bpy.types.Context, plan: Plan, results: list) -> Steps[None]:
        """Generate the caustics of the open frame and append them to `results`; append nothing if nothing is lit."""
        lamps = list(filter(seen_in(context), plan.lamps))
        lacks = self.lacks.setdefault(context.scene.frame_current, [])
        self.receivers, self.layers = {}, 0
        try:
            chosen = visible(context, self._mirrors, self.diffuse, unmirrored=True)
            if lamps:
                asked = Asked(self.places, of_each(plan.settings), False)
                thrown = yield from throwing(context, chosen, lamps, asked)
                results += thrown.objects
                lacks += thrown.lacks
                self.receivers, self.layers = thrown.receivers, thrown.layers
                context.view_layer.update()
        except (NothingSeen, NothingThrown):
            return
        except Refused as refused:
            lacks += refused.sentences

    def by_key(self, results: list) -> dict:
        of_pair = {(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp): obj for obj in results}
        return {key: of_pair[pair] for key, pair in self.pairs.items() if pair in of_pair}

    def materials_of(self, result: bpy.types.Object | None) -> list | None:
        """Return the materials of the lit objects to record for a result."""
        return self.receivers.get(result)

    def clear(self, context: bpy.types.Context, results: list) -> None:
        remove_caustics(still_there(results))

    @property
    def _mirrors(self) -> list:
        return list(dict.fromkeys(mirror for mirror, _ in self.pairs.values()))


def pairs_of(mirrors: list, lamps: tuple) -> dict:
    """Return each mirror and lamp by the name of their caustics."""
    return {name_of(mirror, lamp, list(lamps)): (mirror, lamp) for mirror in mirrors for lamp in lamps}


def playing_light(context: bpy.types.Context, plan: Plan, sequence: Sequence) -> tuple[list, list]:
    """Make the caustics of the file play a sequence, all or none of them. Return the objects, and sentences on what is
    left out.
    """
    mirrors, diffuse = candidates(context, unmirrored=True)
    pairs, scene = pairs_of(mirrors, plan.lamps), context.scene
    lit = [obj for obj in diffuse if obj not in plan.lamps]
    before = left_out_before(context, list(pairs.values())) if plan.leave_out is None else {}
    left_out = {pair: before.get(pair, plan.leave_out is not False) for pair in pairs.values()}
    objects: list = []
    told: list = []
    shown = materials_shown(context.evaluated_depsgraph_get(), [mirror for mirror, _ in pairs.values()])
    with AllOrNothing() as whole:
        players = {key: player_of(sequence, Assembly.of(mirror), None, whole, key)
                   for key, (mirror, _) in pairs.items()}
        for key, player in players.items():
            for earlier in results_with(context, *pairs[key])[:1]:
                told += told_of(earlier, set_free(context, earlier, whole))
            obj = play_caustics(context, player, key, pairs[key], lit, whole)
            obj.reflection_mesh.eyes = sequence.records[-1].made_with["places"][key]
            whole.after(keep_own, obj, not left_out[pairs[key]])
            objects.append(obj)
            told += leave_out(scene, *pairs[key], shown[pairs[key][0]], whole) if left_out[pairs[key]] else []
        materials = (slot.material for obj in lit for slot in obj.material_slots)
        told += follow_layers(scene, sequence.layers, materials, whole)
    return objects, told
