"""A scene that moves, baked frame by frame, and what must come of it."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np
import parts
from played import generated

FRAMES = [1, 2, 3, 4]


def bake(room, *arguments) -> int:
    return room("addon.command_line").run(["bake", *map(str, arguments)])


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def expected(frame: int, light: bool = False, **options) -> dict:
    """What `generate` makes of a frame of the open file."""
    bpy.context.scene.frame_set(frame)
    parts.select()
    result = parts.generate(**options)
    if light:
        bpy.ops.reflection_mesh.light(samples=4)
    return generated(result)


def assert_same(told: dict, frame: int, name: str, wanted: dict) -> None:
    for what, values in wanted.items():
        found = told[f"{frame} {name} {what}"]
        assert found.dtype == values.dtype or what == "materials", what
        if ": FACE FLOAT " in what:
            # the mean of three equal numbers
            assert np.allclose(found, values, rtol=2e-7, atol=0.0), what
        elif what == "origin":
            assert np.allclose(found, values, atol=1e-6)
        else:
            assert np.array_equal(found, values), what


def lit_scene() -> None:
    """The cube grey and lit by a lamp, so that each frame has a light of its own."""
    cube = bpy.data.objects["Box"]
    for slot in cube.material_slots:
        slot.material = parts.material("Grey", "DIFFUSE")
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 300.0
    place = bpy.data.objects.new("Lamp", lamp)
    place.location = (2.0, -4.0, 3.0)
    bpy.context.scene.collection.objects.link(place)


def operate(out: Path, **options) -> None:
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", filepath=str(out), **options) == {"FINISHED"}


def add_camera(name: str, place: tuple, turn: tuple) -> bpy.types.Object:
    camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
    camera.location, camera.rotation_euler = place, turn
    bpy.context.scene.collection.objects.link(camera)
    return camera


def stopped_at_each_stage(steps: Callable[[str], Iterator], check: Callable[[str], None]) -> list[str]:
    """Run `steps`, of a folder's name, to their end, then anew up to each stage that they tell, where they are closed;
    `check` is asked each time. Returns the stages."""
    told = list(dict.fromkeys(stage for _, stage in steps("all")))
    check("all")
    for index, stage in enumerate(told):
        running = steps(f"out{index}")
        # what was slow once, and told for that, may be quick now: then it runs to its end
        any(now == stage for _, now in running)
        running.close()
        check(stage)
    return told
