"""Baking in several view layers, one after another: each is the context's while its frames are made."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy

from ....core import ReflectionError
from ...faults import Steps, part
from ...frames import FrameRecord, Sequence
from ...writing import show_in_layer
from .bake import baking
from .plan import Plan
from .playing import showing


@dataclass(frozen=True)
class BakedLayer:
    """A view layer that was baked, its plan and its sequences."""

    layer: bpy.types.ViewLayer
    plan: Plan
    sequences: list[Sequence]


def baking_layers(context: bpy.types.Context, layers: list, planned: Callable[[str], Plan],
                  written: Callable[[FrameRecord], None], remark: Callable[[str], None]) -> Steps[list[BakedLayer]]:
    """Bake what each of the view layers sees, yielding (fraction, stage).

    Parameters
    ----------
    planned : callable
        The plan in a view layer that is the context's, by the name that tells its sequences from those of others.
    written, remark : callable
        As `baking` has them.

    Raises
    ------
    ReflectionError
        As `baking`, and where light that mirrors throw is asked for in several view layers.
    """
    made, share = [], 1.0 / len(layers)
    for number, layer in enumerate(layers):
        with context.temp_override(scene=context.scene, view_layer=layer):
            plan = planned(layer.name if len(layers) > 1 else "")
        if plan.lamps and len(layers) > 1:
            raise ReflectionError("Light that mirrors throw is baked for one view layer at a time: choose one.")
        steps = _within(context, layer, baking(context, plan, written, remark))
        made.append(BakedLayer(layer, plan, (yield from part(steps, number * share, share))))
    return made


def show_layers(context: bpy.types.Context, made: list[BakedLayer]) -> tuple[list, list[str]]:
    """Make the file play the baked sequences. With several view layers, each shows only its own. Return the objects,
    and sentences on what is left out.
    """
    objects, remarks = [], []
    for baked in made:
        with context.temp_override(scene=context.scene, view_layer=baked.layer):
            own, told = showing(context, baked.plan, baked.sequences)
        if len(made) > 1:
            show_in_layer(context.scene, baked.layer, own)
        objects, remarks = objects + own, remarks + told
    return objects, remarks


def _within(context: bpy.types.Context, layer: bpy.types.ViewLayer, steps: Steps) -> Steps:
    """Run the steps with the view layer as the context's, but not between the steps."""
    scene = context.scene
    try:
        while True:
            with context.temp_override(scene=scene, view_layer=layer):
                told = next(steps)
            yield told
    except StopIteration as stop:
        return stop.value
    finally:
        with context.temp_override(scene=scene, view_layer=layer):
            steps.close()
