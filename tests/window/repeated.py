"""Operators that are repeated: F9, Shift-R, Repeat History and Ctrl-Z, in a real window that goes on drawing.

    blender --enable-event-simulate --python tests/window/repeated.py

from the folder of this repository. A timer ticks all the while. After Generate Reflection and after Light Reflection
the script changes a value in the panel that F9 opens, presses Shift-R, and takes back by Ctrl-Z. It asserts that

- the new value is used, and the work can be seen and ended by ESC, which leaves the result as it was;
- no key keeps the window waiting for longer than `LONGEST`.

Pictures go to the folder WINDOW_SHOTS, build/window where that is not set.
"""
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
from hands import Screen, room_opened, run, settled, shot, waiting

LONGEST = 1.0   # seconds of work between two ticks
HANGS = 10.0    # seconds between two ticks, on a machine that does other work besides
TICK = 0.02
SAMPLES = 32    # of light
FIELD = {"x": 217, "y": -50}    # from the mouse to the first field of the panel that F9 opens
LIGHT = "REFLECTION_MESH_OT_light"

ticks: list = []


def tick() -> float:
    ticks.append((time.monotonic(), time.thread_time()))
    return TICK


def longest(what: str) -> None:
    """Assert that the window went on since this was last called, and print what it waited for at most.

    Other programs may keep the machine busy: what counts is the processor time of the thread that draws the window.
    """
    waited, worked = (max(after - before for before, after in zip(times, times[1:])) for times in zip(*ticks))
    ticks[:-1] = []
    print(f"{what}: {waited:.2f} s between two looks at most, {worked:.2f} s of work", flush=True)
    assert worked < LONGEST and waited < HANGS, f"{what} keeps the window waiting."


def result() -> bpy.types.Object | None:
    return next((obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"), None)


def at_work(screen: Screen, name: str) -> bool:
    return name in [operator.bl_idname for operator in screen.window.modal_operators]


def steps():
    screen = yield from room_opened()
    bpy.app.timers.register(tick)
    yield 1.0
    yield from screen.search("generate reflection")
    screen.press("RET")
    yield from waiting(result, "a reflection")
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Generate")
    longest("generate")
    faces = len(result().data.polygons)
    yield from changed_by_f9(screen, "8", "r1_generate_again")
    yield from waiting(lambda: len(result().data.polygons) < 0.8 * faces, "a coarser reflection by F9")
    longest("generate by F9")
    yield from settled("r2_generated_again")
    # the panel is still open
    screen.press("ESC")
    yield 1.0
    yield from lit(screen)


def changed_by_f9(screen: Screen, value: str, name: str):
    """Press F9 and type another value into the first field."""
    screen.point(**screen.centre)
    yield 0.5
    screen.press("F9")
    yield 1.0
    screen.move(**FIELD)
    yield 0.5
    screen.press("RET")
    yield 0.5
    yield from screen.write(value)
    screen.press("RET")
    yield 1.0
    shot(name)


def lit(screen: Screen):
    """Light, with more samples by F9, ended by ESC, and once more by Shift-R; and taken back."""
    bpy.context.scene.reflection_mesh.light_samples = 4
    yield from screen.search("light reflection")
    screen.press("RET")
    yield from waiting(lambda: result().reflection_mesh.light_material, "light")
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Light")
    longest("light")
    first = result().reflection_mesh.light_material.session_uid
    yield from changed_by_f9(screen, str(SAMPLES), "r3_light_again")
    yield from waiting(lambda: at_work(screen, LIGHT), "Light at work after F9", 5.0)
    yield 2.0
    shot("r4_light_at_work")

    def ended() -> bool:
        # while Cycles renders a key that nobody pressed does not end it
        screen.press("ESC")
        return not screen.window.modal_operators
    yield from waiting(ended, "the end of Light after ESC", 60.0)
    longest("light by F9 and ESC")
    assert result().reflection_mesh.light_material.session_uid == first, "ESC has taken the light."
    screen.press("ESC")
    yield from settled("r5_light_escaped")
    screen.point(**screen.centre)
    yield 0.5
    screen.press("R", shift=True)
    yield from waiting(lambda: at_work(screen, LIGHT), "Light at work after Shift-R", 5.0)
    yield from waiting(lambda: not screen.window.modal_operators, "the end of Light by Shift-R", 120.0)
    assert result().reflection_mesh.light_material.session_uid != first
    longest("light by Shift-R")
    screen.press("Z", ctrl=True)
    yield 2.0
    longest("Ctrl-Z")
    assert result().reflection_mesh.light_material is not None
    yield from settled("r6_taken_back")


if __name__ == "__main__":
    run(steps)
