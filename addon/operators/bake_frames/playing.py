"""Sequences that were baked, shown by the file: objects that play them."""
from __future__ import annotations

import bpy

from ...faults import AllOrNothing, listed
from ...frames import Sequence, light_of, make_way, play, player_of, results_to_play, show_always, show_by_camera
from ...lighting import update_mattes
from ...reading import Participants, candidates
from ...writing import set_free, told_of
from ..assembled import assembled
from .plan import Plan
from .thrown_light import playing_light


def playing(context: bpy.types.Context, plan: Plan, sequences: list[Sequence]) -> tuple[list, list]:
    """Make the results of the mirrors play baked sequences. If that fails for one of them, undo it for all.

    Parameters
    ----------
    context : bpy.types.Context
    plan : Plan
        The plan of the bake. Its settings decide which mirrors share one result.
    sequences : list of Sequence
        One for each camera, or a single one that follows the active camera.

    Returns
    -------
    objects : list of bpy.types.Object
        The results that play, one for each sequence and each mirror or group of joined mirrors.
    sentences : list of str
        On other results that are hidden since they would overlap these, and on what users had joined to a result, which
        is an object of its own again.
    """
    mirrors, diffuse = candidates(context)
    joint = assembled(context, Participants(mirrors, diffuse, []), plan.settings)
    with AllOrNothing() as whole:
        players = [player_of(sequence, mirror, light, whole)
                   for sequence in sequences for light in [light_of(sequence, whole)] for mirror in joint]
        freed = [sentence for player in players for result in results_to_play(context, player)[:1]
                 for sentence in told_of(result, set_free(context, result, whole))]
        shown = [(play(context, player, diffuse, whole), player.sequence.camera) for player in players]
        told = freed
        if sequences[0].camera:
            show_by_camera(context.scene, shown)
            if hidden := make_way(context, shown, whole):
                told += [f"Hidden where cameras have sequences of their own: {listed(obj.name for obj in hidden)}."]
        elif hidden := [other for obj, _ in shown for other in show_always(context, obj, whole)]:
            told += [f"Hidden, since what plays is right for every camera: {listed(obj.name for obj in hidden)}."]
    update_mattes(context)
    return [obj for obj, _ in shown], told


def showing(context: bpy.types.Context, plan: Plan, sequences: list[Sequence]) -> tuple[list, list]:
    """Make the file play the sequences of a plan. Return the objects, and sentences on what is left out."""
    return playing_light(context, plan, sequences[0]) if plan.lamps else playing(context, plan, sequences)
