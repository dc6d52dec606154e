"""What a job of Open Job Description writes, as a picture for docs/tutorials.md; made by `python -m
tools.pictures.tutorials`.

The job is farm/openjd_bake.yaml, run by openjd-cli: one task alone that is not the first, one that is stopped half way,
and then all of it. A Blender without the extension renders the film.
"""
from __future__ import annotations

import math
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib
from PIL import Image

from tools import extension_zip
from tools.pictures.samples import SAMPLES

FRAMES, PER_TASK = 6, 2
WIDTH, HEIGHT, SWING = 264, 264, (-0.1, 0.5)  # pixels; of the camera round the ball, from and to, radians
LIGHT_SAMPLES, FILM_SAMPLES = 24, 64
STEPS = (("the task of frames 5 and 6", ("--step", "Bake", "--tasks", '[{"Frame": "5-6"}]')),
         ("that of 3 and 4, stopped after 3", ("--step", "Bake", "--tasks", '[{"Frame": "3-4"}]')),
         ("all that is missing", ("--step", "Play", "--run-dependencies")))
COLOURS = ("#0072B2", "#D55E00", "#222222")
FILM = """
import sys, bpy
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
bpy.context.scene.render.filepath = sys.argv[2]
bpy.ops.render.render(animation=True)
"""


def farm(path: Path, scratch: Path) -> None:
    """Run the job, render the film and draw both into one picture."""
    _save_shot(scratch / "shot.blend")
    blender, out = _program(scratch / "blender"), scratch / "frames"
    started, told = time.time(), []
    for number, (_, asked) in enumerate(STEPS):
        _run(scratch, blender, asked, out / "Frame.0003.json" if number == 1 else None)
        made = sorted((file for file in out.iterdir() if not any(file.name == name for _, name, *_ in told)),
                      key=lambda file: file.stat().st_mtime_ns)
        told += [(number, file.name, file.stat().st_size, file.stat().st_mtime - started) for file in made]
    film = _film(out / "shot reflections.blend", scratch)
    _draw(path, told, film)


def _save_shot(path: Path) -> None:
    """The room, with a camera that goes round the ball, and things that turn."""
    import bpy
    from mathutils import Matrix
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "room.blend"))
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.cycles.samples, scene.cycles.use_denoising = FILM_SAMPLES, True
    scene.frame_start, scene.frame_end = 1, FRAMES
    ball, camera, head = (scene.objects[name] for name in ("Golden Ball", scene.camera.name, "Suzanne"))
    rest, centre, turned = camera.matrix_world.copy(), ball.matrix_world.translation, head.rotation_euler.z
    for frame in range(1, FRAMES + 1):
        part = (frame - 1) / (FRAMES - 1)
        turn = Matrix.Rotation(SWING[0] + part * (SWING[1] - SWING[0]), 4, "Z")
        camera.matrix_world = Matrix.Translation(centre) @ turn @ Matrix.Translation(-centre) @ rest
        head.rotation_euler.z = turned + math.pi * part
        for obj, what in ((camera, "location"), (camera, "rotation_euler"), (head, "rotation_euler")):
            obj.keyframe_insert(what, frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def _program(path: Path) -> Path:
    """A program that takes what a farm gives to Blender, and goes by the module."""
    script = extension_zip.ROOT / "addon" / "run_with_bpy.py"
    path.write_text(f"#!{sys.executable}\nimport os, sys\nos.execv(sys.executable, [sys.executable, {str(script)!r}, "
                    "sys.argv[2], *sys.argv[5:]])\n")
    path.chmod(0o755)
    return path


def _run(folder: Path, blender: Path, asked: tuple, until: Path | None) -> None:
    """The job, or a part of it, to its end or until there is a file.

    Raises
    ------
    RuntimeError
        Where it fails.
    """
    parameters = {"SceneFile": folder / "shot.blend", "OutputFolder": folder / "frames", "Frames": f"1-{FRAMES}",
                  "FramesPerTask": PER_TASK, "Samples": LIGHT_SAMPLES, "Blender": blender}
    command = [str(Path(sys.executable).with_name("openjd")), "run",
               str(extension_zip.ROOT / "farm" / "openjd_bake.yaml"), *asked]
    for name, value in parameters.items():
        command += ["-p", f"{name}={value}"]
    with (folder / "log.txt").open("w+") as log, subprocess.Popen(command, stdout=log, stderr=log,
                                                                  env=_alone(folder)) as job:
        while job.poll() is None:
            if until is not None and until.exists():
                job.send_signal(signal.SIGINT)
                break
            time.sleep(0.02)
        if job.wait() and until is None:
            log.seek(0)
            raise RuntimeError(log.read())


def _alone(folder: Path) -> dict:
    """The environment of a Blender without extensions."""
    return {**os.environ, "BLENDER_USER_RESOURCES": str(folder / "none"), "PYTHONDONTWRITEBYTECODE": "1"}


def _film(path: Path, folder: Path) -> list[Path]:
    """The frames of the film, rendered without the extension."""
    subprocess.run([sys.executable, "-c", FILM, str(path), str(folder / "film")], check=True, env=_alone(folder),
                   stdout=subprocess.DEVNULL)
    return [folder / f"film{frame:04}.png" for frame in range(1, FRAMES + 1)]


def _draw(path: Path, told: list, film: list[Path]) -> None:
    """The film above; below each run, and the files that it wrote in the order in which they came."""
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure = pyplot.figure(figsize=(9.9, 4.1), dpi=120, facecolor="white")
    made_by = {int(name.split(".")[1]): number for number, name, *_ in told if name.startswith("Frame.")}
    for column, picture in enumerate(film):
        axes = figure.add_axes(((column + 0.02) / FRAMES, 0.6, 0.96 / FRAMES, 0.39))
        axes.imshow(Image.open(picture))
        axes.set_axis_off()
        by = made_by[column + 1]
        axes.set_title(f"frame {column + 1}: run {by + 1}", fontsize=9, color=COLOURS[by], y=-0.14)
    for number, (what, asked) in enumerate(STEPS):
        lines = [f"Run {number + 1}: {what}", "$ openjd run farm/openjd_bake.yaml", f"    {shlex.join(asked)}", ""]
        lines += [f"{seconds:4.0f} s  {_size(size)}  {name}" for by, name, size, seconds in told if by == number]
        figure.text(0.005 + number * 0.337, 0.51, "\n".join(lines), family="monospace", fontsize=7.0, va="top",
                    color=COLOURS[number], linespacing=1.4)
    picture = path.with_suffix(".png")
    figure.savefig(picture)
    pyplot.close(figure)
    with Image.open(picture) as drawn:
        drawn.convert("RGB").save(path, quality=88, optimize=True)
    picture.unlink()


def _size(size: int) -> str:
    return f"{size / 1e6:5.1f} MB" if size > 1e6 else f"{size / 1e3:5.1f} KB"
