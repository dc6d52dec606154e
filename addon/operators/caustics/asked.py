"""What is asked for of the light that mirrors throw, and what of it is as it was."""
from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...illumination import bring_back_own_caustics, places_kept, results_with
from ...reading import Participants
from ...settings import SettingsOfMirrors


@dataclass(frozen=True)
class Asked:
    """What is asked for: places on each lamp, the same for all or by (mirror, lamp); the settings of each mirror;
    whether Cycles' own caustics are left out, for all or by (mirror, lamp); and whether materials that fit are kept."""

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
    """What is `given` of places and of leaving out, and else what the light that there is was generated with."""
    eyes, leave_out = given
    if leave_out is None:
        leave_out = left_out_before(context, [(mirror, lamp) for mirror in chosen.mirrors for lamp in lamps])
    return Asked(places_kept(context, chosen.mirrors, lamps) if eyes is None else eyes, settings, leave_out)


def left_out_before(context: bpy.types.Context, pairs: list) -> dict:
    """Whether Cycles' own caustics were left out, by those (mirror, lamp) of `pairs` whose light is there."""
    return {pair: not obj.reflection_mesh.keeps_own for pair in pairs for obj in results_with(context, *pair)[:1]}


def left_out_of(objects: list) -> bool | None:
    """Whether Cycles' own caustics are left out for all of this light, or kept for all; None where some are."""
    left_out = {not obj.reflection_mesh.keeps_own for obj in objects}
    return left_out.pop() if len(left_out) == 1 else None


def remember(objects: list, asked: Asked) -> None:
    """Let light know what it was asked for, for the next time; how many places it comes from it knows."""
    for obj in objects:
        keep_own(obj, not asked.leaves_out(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp))


def keep_own(light: bpy.types.Object, keeps: bool) -> None:
    """Let light know whether Cycles adds caustics of its own, and its lamp light the mirror again if so."""
    record = light.reflection_mesh
    record.keeps_own = keeps
    if keeps:
        bring_back_own_caustics(record.lamp, record.mirror)
