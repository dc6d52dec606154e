"""Pictures of runs: the ways in, what is asked before, the progress, and what F9 opens afterwards."""
from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import bpy
import hands

from .taking import GAP, MIRROR, alone, dragged, joined, opened, part

STATUS = 24         # pixels, the height of the status bar
WAYS = 280          # the height of the pictures of the menu and of F3
BROWSER_AT, BROWSER = (60, 60), (1104, 500)     # where a file browser's window is put, and its size
PLACES, OPTIONS = 249, 249                      # the widths of what is at its left and at its right


def ways_in():
    screen = yield from opened("room")
    alone(MIRROR)
    area = screen.area
    screen.point(area.x + 120, area.y + 420)
    yield 0.5
    with screen.context():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_reflection_mesh")
    yield from hands.settled("menu")
    screen.press("ESC")
    yield 0.5
    yield from screen.search("reflection")
    yield from hands.settled("search")
    screen.press("ESC")
    yield 0.5
    bpy.context.scene.reflection_mesh.tolerance = 0.003
    screen.point(**screen.centre)
    with screen.context():
        bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT")
    yield 7.0
    hands.shot("progress")
    screen.press("ESC")
    yield from hands.waiting(lambda: not screen.window.modal_operators, "the end after ESC")
    joined("ways_in", [part("menu", 0, screen.window.height - WAYS - 280, 460, WAYS),
                       part("search", 640, 405, 540, WAYS)],
           below=part("progress", 0, screen.window.height - STATUS, 460 + GAP + 540, STATUS))


def after_run():
    screen = yield from opened("room")
    bpy.context.scene.render.resolution_percentage = 20
    alone(MIRROR)
    screen.point(**screen.centre)
    for name, words, made in (("generated", "generate reflection", bpy.data.objects),
                              ("lit", "light reflection", bpy.data.images)):
        yield from screen.search(words)
        screen.press("RET")
        yield from hands.waiting(lambda made=made: not screen.window.modal_operators and any(
            "Reflection" in one.name for one in made), name, 180.0)
        screen.point(**screen.centre)
        yield 0.5
        screen.press("F9")
        yield 1.0
        screen.move(x=5, y=-5)
        yield from hands.settled(name)
        screen.press("ESC")
        yield 0.5
    joined("after_run", [part("generated", 646, 410, 338, 400), part("lit", 646, 410, 338, 126)])


def bake():
    screen = yield from opened("room")
    # a short name, since it is seen
    folder = Path(tempfile.gettempdir(), "film")
    folder.mkdir()
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "room.blend"))
        yield from browser(screen)
    finally:
        shutil.rmtree(folder)


def browser(screen: hands.Screen):
    alone(MIRROR)
    with screen.context():
        bpy.ops.reflection_mesh.bake("INVOKE_DEFAULT")
    yield 3.0
    # the browser has a window of its own, which stands out of the screen without a window manager
    subprocess.run(["xdotool", "search", "--name", "Blender File View", "windowmove", *map(str, BROWSER_AT),
                    "windowsize", *map(str, BROWSER)], check=True)
    screen.window = bpy.context.window_manager.windows[-1]
    yield 2.0
    yield from dragged(screen, BROWSER[0] - OPTIONS, 300, x=-60)
    screen.point(BROWSER[0] // 2, 150)
    yield from hands.settled("bake")
    joined("bake", [part("bake", BROWSER_AT[0] + PLACES, BROWSER_AT[1], BROWSER[0] - PLACES, BROWSER[1])])
    screen.press("ESC")
    yield 2.0


def mirror_uvs():
    screen = yield from opened("anamorphosis")
    scene, space = bpy.context.scene, screen.area.spaces.active
    scene.render.engine, scene.cycles.preview_samples, scene.cycles.use_preview_denoising = "CYCLES", 16, True
    space.shading.type, space.show_gizmo = "RENDERED", False
    with screen.context():
        # as a button does, so that F9 knows of it
        bpy.ops.reflection_mesh.mirror_uvs("EXEC_DEFAULT", True, picture="Compass", frame="WHOLE")
    screen.point(185, screen.window.height - 140)
    yield 0.5
    screen.press("F9")
    yield 1.0
    screen.move(x=5, y=-5)
    # nothing tells how far Cycles is, and pictures of one second after another may be the same
    yield 110.0
    hands.shot("mirror_uvs")
    joined("mirror_uvs", [part("mirror_uvs", 172, 127, 670, 463)])
    screen.press("ESC")
    yield 0.5
    space.show_gizmo = True
