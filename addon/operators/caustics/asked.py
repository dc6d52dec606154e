"""The requested settings of caustics, and those kept from the last time."""
from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...illumination import bring_back_own_caustics, places_kept, results_with
from ...reading import Participants
from ...settings import SettingsOfMirrors


@dataclass(frozen=True)
class Asked:
    """Requested settings of caustics.

    Attributes
    ----------
    eyes : int or dict
        Number of points on each lamp, for all or by (mirror, lamp).
    settings : callable
        Function from a mirror to its settings.
    leave_out : bool or dict
        Leave out Cycles' own caustics, for all or by (mirror, lamp).
    keep_materials : bool
        Keep existing materials that fit.
    """

    eyes: int | dict
    settings: SettingsOfMirrors
    leave_out: bool | dict
    keep_materials: bool = False

    def places(self, mirror: bpy.types.Object, lamp: bpy.types.Object) -> int:
        return self.eyes.get((mirror, lamp), 1) if isinstance(self.eyes, dict) else self.eyes

    def leaves_out(self, mirror: bpy.types.Object, lamp: bpy.types.Object) -> bool:
        return self.leave_out.get((mirror, lamp), True) if isinstance(self.leave_out, dict) else self.leave_out


def asked_again(context: bpy.types.Context, chosen: Participants, lamps: list, settings: SettingsOfMirrors,
                given: tuple[int | None, bool | None]) -> Asked:
    """Return the settings in `given`, the number of points and the choice to leave out Cycles' caustics. A None is
    replaced by the settings of the existing caustics.
    """
    eyes, leave_out = given
    if leave_out is None:
        leave_out = left_out_before(context, [(mirror, lamp) for mirror in chosen.mirrors for lamp in lamps])
    return Asked(places_kept(context, chosen.mirrors, lamps) if eyes is None else eyes, settings, leave_out)


def left_out_before(context: bpy.types.Context, pairs: list) -> dict:
    """Return, for those (mirror, lamp) in `pairs` that have caustics, True if Cycles' own caustics were left out."""
    return {pair: not obj.reflection_mesh.keeps_own for pair in pairs for obj in results_with(context, *pair)[:1]}


def left_out_of(objects: list) -> bool | None:
    """Return True if Cycles' own caustics are left out for all of these caustics, False if for none, None if for some.
    """
    left_out = {not obj.reflection_mesh.keeps_own for obj in objects}
    return left_out.pop() if len(left_out) == 1 else None


def remember(objects: list, asked: Asked) -> None:
    """Record on the caustics what was requested, for the next time. The number of points is already recorded."""
    for obj in objects:
        keep_own(obj, not asked.leaves_out(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp))


def keep_own(light: bpy.types.Object, keeps: bool) -> None:
    """Record on caustics if Cycles adds its own. If it does, let the lamp light the mirror again."""
    record = light.reflection_mesh
    record.keeps_own = keeps
    if keeps:
        bring_back_own_caustics(record.lamp, record.mirror)
