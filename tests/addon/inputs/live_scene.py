"""A scene for Live, told of changes by real handlers and driven by a clock of the tests'."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import bpy
import numpy as np
import parts

TICK = 0.02
PAUSE = 1.0  # seconds of the tests' clock in which Live comes to rest


class Clock:
    """Steps of the updater as the timer asks for them; `done` tells what each did."""

    def __init__(self, updater) -> None:
        self.updater, self.now, self.done = updater, 100.0, []

    def run(self, seconds: float = TICK) -> list[str]:
        done = []
        bpy.context.view_layer.update()
        for _ in range(max(1, round(seconds / TICK))):
            done.append(self.updater.step(bpy.context, self.now))
            self.now += TICK
        # what was written tells the handlers too
        bpy.context.view_layer.update()
        self.done += done
        return [what for what in done if what]

    def rest(self) -> list[str]:
        """Until nothing is left to do."""
        done = self.run(PAUSE)
        for _ in range(200):
            if self.updater.at_rest and not self.updater.following.is_under_way:
                break
            done += self.run(PAUSE)
        assert self.updater.at_rest
        assert self.run(PAUSE) == []
        return done


def scene_of(context: bpy.types.Context) -> SimpleNamespace:
    ball = parts.add("uv_sphere", "Ball", segments=16, ring_count=8, location=(0.0, 0.0, 1.0))
    ball.data.shade_smooth()
    leaf = add_leaf()
    ball.reflection_mesh.role, leaf.reflection_mesh.role = "MIRROR", "DIFFUSE"
    result = parts.generate()
    parts.select()
    return SimpleNamespace(ball=ball, leaf=leaf, result=result, camera=context.scene.camera)


@contextmanager
def switched_on(room) -> Iterator[Clock]:
    """Live switched on, at rest; the timer does not run without a window."""
    switch = room("addon.live.switch")
    bpy.context.window_manager.reflection_mesh_live.on = True
    clock = Clock(switch.updater)
    clock.rest()
    try:
        yield clock
    finally:
        switch.stop()


def add_leaf() -> bpy.types.Object:
    return parts.add_triangle("Leaf", [(1.5, -2.0, 0.2), (2.5, -2.0, 0.4), (1.8, -2.5, 1.9)])


def shape(obj: bpy.types.Object) -> tuple:
    """Everything of a result that is seen."""
    return (parts.attribute(obj, "position").tobytes(), parts.corners(obj).tobytes(),
            parts.attribute(obj, "reflected_position").tobytes(), tuple(obj.location))


def generated(*objects: bpy.types.Object) -> tuple:
    """What Generate makes of the scene as it is."""
    parts.select(*objects)
    found = shape(parts.generate())
    parts.select()
    return found


def moved(obj: bpy.types.Object, by=(0.3, 0.0, 0.1)) -> None:
    obj.location = np.array(obj.location) + by
